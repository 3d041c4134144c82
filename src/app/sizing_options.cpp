#include "app/sizing_options.hpp"

#include <CLI/CLI.hpp>
#include <cmath>

#include "app/validators.hpp"

namespace driftmesh::app {

void add_sizing_options(CLI::App& command, SizingOptions& sizing, const char* group) {
  command
      .add_option("--size", sizing.expression, "Edge length as an expression in x and y: \"0.1+0.02*sqrt(x^2+y^2)\"")
      ->type_name("EXPR")
      ->group(group);
  command
      .add_option("--size-mesh", sizing.background,
                  "Edge length from a background mesh: FILE.node with FILE.ele, the length as the first attribute of "
                  "each point, or FILE.area with an area bound for each triangle")
      ->type_name("FILE")
      ->group(group);
  command
      .add_option("--gradation", sizing.gradation,
                  "How much the lengths of --size-mesh may grow per unit of distance; 0.2 to 0.3 grade well")
      ->check(positive())
      ->type_name("G")
      ->group(group);
  command.add_option("--size-min", sizing.shortest, "Edge lengths asked for are at least this")
      ->check(positive())
      ->type_name("LENGTH")
      ->group(group);
  command.add_option("--size-max", sizing.longest, "Edge lengths asked for are at most this")
      ->check(positive())
      ->type_name("LENGTH")
      ->group(group);
}

void check_sizing_options(const SizingOptions& sizing) {
  if (sizing.gradation && sizing.background.empty())
    throw CLI::ValidationError("--gradation", "limits the growth of --size-mesh, which is not given");
  if (sizing.shortest > sizing.longest) throw CLI::ValidationError("--size-min", "is greater than --size-max");
  if (sizing.shortest > 0 && sizing.expression.empty() && sizing.background.empty() && !std::isfinite(sizing.longest))
    throw CLI::ValidationError("--size-min", "bounds --size, --size-mesh and --size-max, of which none is given");
}

}  // namespace driftmesh::app
