#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "driftmesh/id_vector.hpp"
#include "job/domain.hpp"
#include "job/request.hpp"
#include "sim/turns.hpp"

namespace driftmesh::sim {

/// Files in a folder: their contents, by their names.
using Files = std::map<std::string, std::string>;

/// What a run on simulated ranks is, and what befalls it.
struct LifePlan {
  job::Request request;  ///< a checkpoint is written to, and gone on with from, the file kCheckpoint
  job::Given given;
  std::int32_t ranks = 1;
  std::uint64_t seed = 1;
  std::vector<Fault> faults{};
};
inline constexpr const char* kCheckpoint = "run.kept";

/// Errors of the product that the oracles must notice.
enum class Sabotage : std::uint8_t {
  kNone,
  kEarlyRename,  ///< a checkpoint appears before it is complete
};

/// A checkpoint that has been completed.
struct Saved {
  double at = 0;               ///< seconds
  std::int64_t triangles = 0;  ///< that all ranks had
  std::string content;
};

/// What has become of it.
struct Life {
  std::optional<std::uint64_t> digest{};  ///< that the mesh has, if one was made
  std::int64_t triangles = 0;             ///< in the mesh
  std::vector<std::string> errors{};      ///< what ranks have said, each once
  std::string abort{};                    ///< why a rank ended the job
  std::vector<std::string> lines{};       ///< what was said of ranks that do not answer
  bool stuck = false;                     ///< all would have waited forever
  std::optional<double> ended{};          ///< when the job was ended
  std::vector<Fault> met{};
  std::optional<Saved> saved{};  ///< the last one of this life
  int saves = 0;
  std::int32_t ranks = 1;
  int refused = 0;                   ///< warnings that one could not be written
  bool has_begun = false;            ///< all ranks have refined
  std::int64_t first_triangles = 0;  ///< what they began with, after a slice of work of each at most
  double began = 0;                  ///< when the last of them had
  double seconds = 0;
  Files files{};  ///< what is left on the disk
};

/// Makes a mesh as the program does, by its own code from the settings to the last digit, in a folder with these files.
[[nodiscard]] Life live(const LifePlan& plan, const Files& files, Sabotage sabotage = Sabotage::kNone);

}  // namespace driftmesh::sim
