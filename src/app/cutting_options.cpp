#include "app/cutting_options.hpp"

#include <CLI/CLI.hpp>

namespace driftmesh::app {

void add_cutting_options(CLI::App& command, const CuttingOptions& options, const std::string& group) {
  command
      .add_option("--separator-angle", *options.separator_angle,
                  "Separators keep this angle, in degrees, to everything where the domain allows it")
      ->check(CLI::Range(0.0, 80.0).description(""))
      ->capture_default_str()
      ->type_name("DEGREES")
      ->group(group);
  command
      .add_option("--split-skew", *options.skew,
                  "Deliberately uneven subdomains, for experiments: each cut gives one side up to 1 + S times its due")
      ->check(CLI::Range(0.0, 10.0).description(""))
      ->type_name("S")
      ->group(group);
  command.add_option("--seed", *options.seed, "Of the unevenness")->capture_default_str()->type_name("N")->group(group);
}

}  // namespace driftmesh::app
