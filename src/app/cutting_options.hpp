#pragma once

#include <cstdint>
#include <string>

namespace CLI {
class App;
}

namespace driftmesh::app {

/// How a domain is cut into subdomains: where the options store their values.
struct CuttingOptions {
  double* separator_angle;
  double* skew;
  std::uint64_t* seed;
};

/// Adds --separator-angle, --split-skew and --seed to a subcommand, in a group of its help.
void add_cutting_options(CLI::App& command, const CuttingOptions& options, const std::string& group);

}  // namespace driftmesh::app
