#pragma once

#include <map>
#include <string>
#include <vector>

#include "bench/models.hpp"
#include "bench/report.hpp"

namespace driftmesh::bench {

struct Options {
  double degrees = 20;
  double cells =
      7.04e6;  ///< the area bound is the domain's area divided by this; there are 1.55 times as many triangles
  std::size_t parts = 1000;  ///< subdomains in the cut suite
  int repetitions = 3;
  std::vector<double> growth = {0.645e6, 6.45e6, 64.5e6};  ///< cells of the growth suite: 1, 10, 100 million triangles
};

using Suite = std::vector<Measurement> (*)(const std::vector<Model>& models, const Options& options);

/// Every suite by name.
[[nodiscard]] const std::map<std::string, Suite>& suites();

}  // namespace driftmesh::bench
