#pragma once

#include <string>

#include "cluster/replay/replay.hpp"

namespace driftmesh::study {

/// A run from its record, with the times that it took.
struct RecordOfRun {
  RecordedRun run;
  std::string policy;
  double seconds = 0, ideal = 0, oracle = 0;
  std::size_t moves = 0;
};

/// Reads the record of a run that `driftmesh run` wrote. Throws InputError if it is none, or lacks what replay() needs.
[[nodiscard]] RecordOfRun read_recorded_run(const std::string& path);

}  // namespace driftmesh::study
