#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "driftmesh/repair.hpp"
#include "driftmesh/simplify.hpp"
#include "job/domain.hpp"
#include "job/mesh_facts.hpp"
#include "job/request.hpp"
#include "job/watch.hpp"
#include "runtime/rank_outcome.hpp"

namespace driftmesh::job {

/// The checkpoints that a run has written.
struct CheckpointRecord {
  std::int64_t count = 0;
  double seconds = 0;       ///< for all of them
  std::uint64_t bytes = 0;  ///< what the last one takes
};

/// All facts about the generation of one mesh, for its summary and its JSON file. Times are in seconds, memory in
/// bytes, angles in degrees.
struct RunRecord : MeshFacts {
  Request request;
  std::string command;  ///< a command line that makes the same mesh
  std::string input_file;
  std::string projection;                                                                 ///< see InputFile
  std::int64_t input_points = 0, input_segments = 0, input_holes = 0, input_regions = 0;  ///< after repair
  RepairReport repairs;                                                                   ///< without its warnings
  SimplifyReport simplified;                                                              ///< without its points
  ClosedChannels closed;                                                                  ///< likewise
  std::vector<Creek> creeks;                                                              ///< see Domain
  std::vector<std::string> warnings;                                                      ///< about the input

  double min_angle = 0;
  double max_area = 0;  ///< <= 0: no bound
  std::string sizing;   ///< the size field in words, or empty

  bool complete = true;
  std::string stopped_by;  ///< the key of the limit that stopped the work, if it is not complete
  std::int32_t acute_corners = 0;
  double forecast = 0;  ///< triangles, before refinement

  std::vector<StageTime> stages;
  double seconds_refine = 0;
  double seconds = 0;  ///< all stages and the time between them
  std::uint64_t peak_refining = 0, peak = 0;

  struct File {
    std::string name;
    std::uint64_t bytes;
  };
  std::vector<File> files;

  /// One rank of a parallel run.
  struct Rank : RankOutcome {
    std::uint64_t peak = 0;
  };
  std::vector<Rank> ranks;  ///< empty if there were none
  bool on_threads = false;  ///< ranks are threads of one process
  int rounds = 0;           ///< number that threads took (see runtime/threads)
  std::int32_t subdomains = 0;
  bool presplit = false;
  CheckpointRecord checkpoints;

  [[nodiscard]] double triangles_per_second() const {
    return seconds_refine > 0 ? static_cast<double>(triangles) / seconds_refine : 0;
  }
};

/// Throws InputError if the request is strict and there are triangles that do not allow its time step.
void require_step(const RunRecord& run);

/// Fills in the request and the domain.
void record_domain(RunRecord& run, const Request& request, const Domain& domain);

}  // namespace driftmesh::job
