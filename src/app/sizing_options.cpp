#include "app/sizing_options.hpp"

#include <cmath>

#include "cli/values.hpp"

namespace driftmesh::app {

std::vector<cli::Option> sizing_options(SizingOptions& sizing, const std::string& group) {
  return {{.name = "size",
           .value = "EXPR",
           .help = "Edge length as an expression in x and y: \"0.1+0.02*sqrt(x^2+y^2)\"",
           .group = group,
           .take = cli::into(sizing.expression)},
          {.name = "size-mesh",
           .value = "FILE",
           .help = "Edge length from a background mesh: FILE.node with FILE.ele, the length as the first attribute of "
                   "each point, or FILE.area with an area bound for each triangle",
           .group = group,
           .completes = cli::Option::Completes::kFile,
           .take = cli::into(sizing.background)},
          {.name = "gradation",
           .value = "G",
           .help = "How much the lengths of --size-mesh may grow per unit of distance; 0.2 to 0.3 grade well",
           .group = group,
           .take = cli::into(sizing.gradation, cli::kPositive)},
          {.name = "size-min",
           .value = "LENGTH",
           .help = "Edge lengths asked for are at least this",
           .group = group,
           .take = cli::into(sizing.shortest, cli::kPositive)},
          {.name = "size-max",
           .value = "LENGTH",
           .help = "Edge lengths asked for are at most this",
           .group = group,
           .take = cli::into(sizing.longest, cli::kPositive)}};
}

void check_sizing_options(const SizingOptions& sizing) {
  if (sizing.gradation && sizing.background.empty())
    throw cli::UsageError("--gradation limits the growth of --size-mesh, which is not given");
  if (sizing.shortest > sizing.longest) throw cli::UsageError("--size-min is greater than --size-max");
  if (sizing.shortest > 0 && sizing.expression.empty() && sizing.background.empty() && !std::isfinite(sizing.longest))
    throw cli::UsageError("--size-min bounds --size, --size-mesh and --size-max, of which none is given");
}

}  // namespace driftmesh::app
