#include "app/cutting_options.hpp"

#include "cli/values.hpp"

namespace driftmesh::app {

std::vector<cli::Option> cutting_options(const CuttingOptions& options, const std::string& group) {
  return {{.name = "separator-angle",
           .value = "DEGREES",
           .help = "Separators keep this angle, in degrees, to everything where the domain allows it",
           .standard = "60",
           .group = group,
           .take = cli::into(*options.separator_angle, {0, 80})},
          {.name = "split-skew",
           .value = "S",
           .help = "Deliberately uneven subdomains, for experiments: each cut gives one side up to 1 + S times its due",
           .group = group,
           .take = cli::into(*options.skew, {0, 10})},
          {.name = "seed",
           .value = "N",
           .help = "Seed of the unevenness",
           .standard = "1",
           .group = group,
           .take = cli::into(*options.seed)}};
}

}  // namespace driftmesh::app
