#pragma once

#include <optional>
#include <string>
#include <vector>

#include "driftmesh/adaptive.hpp"
#include "driftmesh/defaults.hpp"
#include "driftmesh/files.hpp"

namespace driftmesh::app {

/// What the command line of driftmesh adapt says.
struct AdaptCommand {
  std::string mesh, output;
  std::string lengths;
  std::vector<std::string> transfers;
  std::string only;
  std::string outline;
  double tolerance = 0;
  static constexpr double kThreshold = 1.2;
  std::optional<double> threshold;  ///< nothing: kThreshold
  std::string map;
  double angle = defaults::kMinAngle;
  AdaptiveOptions options;
  int threads = 0;  ///< 0: one for each core
  bool quiet = false;
  ReadOptions reading;
};

}  // namespace driftmesh::app
