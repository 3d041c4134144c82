#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "cli/command.hpp"

namespace driftmesh::app {

/// How a domain is cut into subdomains: where the options store their values.
struct CuttingOptions {
  double* separator_angle;
  double* skew;
  std::uint64_t* seed;
};

/// --separator-angle, --split-skew and --seed, under a heading of help.
[[nodiscard]] std::vector<cli::Option> cutting_options(const CuttingOptions& options, const std::string& group);

}  // namespace driftmesh::app
