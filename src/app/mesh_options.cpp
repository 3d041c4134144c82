#include "app/mesh_options.hpp"

#include <cmath>
#include <cstdint>
#include <iterator>

#include "app/cutting_options.hpp"
#include "app/sizing_options.hpp"
#include "balancer/policies/policy_factory.hpp"
#include "cli/values.hpp"
#include "decompose/decompose.hpp"

namespace driftmesh::app {
namespace {

using cli::into;
using cli::Option;
constexpr auto kFlag = Option::Kind::kFlag;
constexpr auto kFile = Option::Completes::kFile;

/// The power of a thousand that a unit stands for, or -1.
int power_of(std::string_view unit) {
  if (unit.ends_with('B') || unit.ends_with('b')) unit.remove_suffix(1);
  if (unit.size() == 2 && unit[1] == 'i') unit.remove_suffix(1);
  if (unit.empty()) return 0;
  const std::size_t letter = std::string_view("kKmMgGtT").find(unit.front());
  return unit.size() == 1 && letter != std::string_view::npos ? static_cast<int>(letter) / 2 + 1 : -1;
}

/// A number from 1 to `most` with a unit k, M, G or T, of `thousand` to the power of 1 to 4, or none: "50M", "1.5G",
/// "2e6". A B or iB behind the unit changes nothing.
template <class Number>
cli::Take size_into(Number& to, double thousand, double most) {
  return [=, &to](const std::string& text) {
    const std::size_t unit = std::min(text.size(), text.find_first_not_of("0123456789.+-eE"));
    const int power = power_of(std::string_view(text).substr(unit));
    if (power < 0) throw cli::UsageError("'" + text + "' is not a number with a unit k, M, G or T, or none");
    const double value = std::round(cli::read_number(text.substr(0, unit), {}) * std::pow(thousand, power));
    if (!(value >= 1 && value <= most)) throw cli::UsageError("'" + text + "' is too small or too large");
    to = static_cast<Number>(value);
  };
}

cli::Take angle_into(double& to) {
  return [&to](const std::string& text) {
    to = cli::read_number(text, {});
    if (!(to >= 0 && to <= kMaxAngle))
      throw cli::UsageError("'" + text + "' is not an angle from 0 to " + std::to_string(static_cast<int>(kMaxAngle)) +
                            " degrees; above that refinement need not come to an end");
  };
}

std::vector<Option> quality_options(MeshOptions& options) {
  constexpr const char* kGroup = "Triangles (lengths and areas in the units of the input)";
  std::vector<Option> all{
      {.name = "area",
       .letter = 'a',
       .value = "AREA",
       .help = "No triangle is larger than this",
       .group = kGroup,
       .take = into(options.area, cli::kPositive)},
      {.name = "angle",
       .letter = 'q',
       .value = "DEGREES",
       .help = "No angle is smaller than this, in degrees, from 0 to 34, but for those that small angles of the input "
               "force. Up to 25.6 refinement is proven to end; up to about 33 it does in practice, with more triangles",
       .standard = "20",
       .group = kGroup,
       .take = angle_into(options.angle)}};
  std::ranges::move(sizing_options(options.sizing, kGroup), std::back_inserter(all));
  all.push_back({.kind = kFlag,
                 .name = "no-region-areas",
                 .help = "Ignore the area bounds of the input's regions",
                 .group = kGroup,
                 .take = into(options.no_region_areas)});
  return all;
}

std::vector<Option> limit_options(MeshOptions& options) {
  constexpr const char* kGroup = "Limits";
  return {{.name = "max-triangles",
           .value = "N",
           .help = "Stop at this many triangles, or at once when more are to be expected; 50M is 50 million",
           .group = kGroup,
           .take = size_into(options.max_triangles, 1000, static_cast<double>(MeshRequest{}.max_triangles))},
          {.name = "max-memory",
           .value = "SIZE",
           .help = "Likewise for memory: 6G is 6 GiB",
           .standard = "90 % of what the machine has free",
           .group = kGroup,
           .take = size_into(options.max_memory, 1024, 1e18)},
          {.kind = kFlag,
           .name = "keep-incomplete",
           .help = "Write what was made when a limit stops the work (not in subdomains)",
           .group = kGroup,
           .take = into(options.keep_incomplete)}};
}

std::vector<Option> parts_options(MeshOptions::Parts& parts) {
  constexpr const char* kGroup = "Many ranks and subdomains (mpirun -n P driftmesh mesh ...)";
  std::vector<Option> all{
      {.name = "subdomains",
       .letter = 'n',
       .value = "N",
       .help = "Cut the domain into so many subdomains, far more than ranks; works without mpirun, too",
       .standard = "20 a rank, or what keeps a subdomain in cache",
       .group = kGroup,
       .take = into(parts.subdomains, {1, kMaxSubdomains})},
      {.name = "decomposition",
       .value = "FILE",
       .help = "Take the subdomains from this file of driftmesh decompose",
       .group = kGroup,
       .completes = kFile,
       .take = into(parts.decomposition)}};
  std::ranges::move(cutting_options({&parts.separator_angle, &parts.skew, &parts.seed}, kGroup),
                    std::back_inserter(all));
  std::ranges::move(
      std::vector<Option>{
          {.name = "mapping",
           .value = "HOW",
           .help = "How subdomains are dealt to ranks at the start: graph (balanced, short interfaces), block or "
                   "round-robin",
           .standard = "graph",
           .group = kGroup,
           .choices = {"graph", "block", "round-robin"},
           .take = into(parts.mapping)},
          {.kind = kFlag,
           .name = "map-by-area",
           .help = "Deal out area instead of expected work: an uneven start, for experiments",
           .group = kGroup,
           .take = into(parts.map_by_area)},
          {.name = "speeds",
           .value = "S,S,...",
           .help = "Relative speed of each rank, where known: work is dealt in proportion, as in --speeds 1,1,2.5",
           .group = kGroup,
           .take = into(parts.speeds, cli::kPositive)},
          {.name = "presplit",
           .value = "MODE",
           .help = "Cut interfaces to size before refinement: off is the protocol in full, auto is on wherever a bound "
                   "on area or size says what size. On, and with one bound on area everywhere, the mesh depends on the "
                   "subdomains alone wherever the input has no features that ask for more",
           .standard = "auto",
           .group = kGroup,
           .choices = {"auto", "on", "off"},
           .take = into(parts.presplit)},
          {.name = "aggregation",
           .value = "K",
           .help = "Split points that travel together at most",
           .standard = std::to_string(parts.aggregation),
           .group = kGroup,
           .take = into(parts.aggregation, {1, 1e6})},
          {.name = "order",
           .value = "ORDER",
           .help = "Which subdomain a rank refines next: given (neighbors together), largest or backlog",
           .standard = "given",
           .group = kGroup,
           .choices = {"given", "largest", "backlog"},
           .take = into(parts.order)},
          {.kind = kFlag,
           .name = "sleep",
           .help = "Keep finished subdomains in about 10 bytes a triangle instead of 40, until a neighbor needs one "
                   "again",
           .group = kGroup,
           .take = into(parts.sleep)}},
      std::back_inserter(all));
  return all;
}

std::vector<Option> balancing_options(MeshOptions::Parts& parts) {
  constexpr const char* kGroup = "Balancing: subdomains move between ranks while they are refined";
  return {{.name = "balance",
           .value = "POLICY",
           .help = "Who decides what moves (docs/balancing.md)",
           .standard = "none",
           .group = kGroup,
           .choices = balancer::policy_names(),
           .take = into(parts.policy)},
          {.name = "balance-with",
           .value = "NAME=VALUE",
           .help = "A parameter of the policy, as in --balance-with method=graph; can be given several times",
           .group = kGroup,
           .repeats = true,
           .take = into(parts.policy_parameters)},
          {.name = "drag",
           .value = "F,F,...",
           .help = "For experiments: the fraction of its time that each rank works, as in --drag 1,0.5; it sleeps "
                   "through the rest",
           .group = kGroup,
           .take = into(parts.drag, {0.01, 1})}};
}

std::vector<Option> output_options(MeshOptions& options) {
  constexpr const char* kGroup = "Output";
  return {
      {.name = "output",
       .letter = 'o',
       .value = "FILE",
       .help = "Mesh file, by extension: .vtu (ParaView), .pvtu (the same in pieces, one a rank; in subdomains only), "
               ".msh (Gmsh 4.1), or .node, .ele, .poly, .edge, .neigh (any of them writes Triangle's whole set). Can "
               "be given several times; without it, the summary alone",
       .group = kGroup,
       .repeats = true,
       .completes = kFile,
       .take = into(options.outputs)},
      {.name = "plot",
       .value = "FILE",
       .help = "Picture of the mesh: .png, .svg or .pdf (more: driftmesh plot --help)",
       .group = kGroup,
       .completes = kFile,
       .take = into(options.picture)},
      {.name = "json",
       .value = "FILE",
       .help = "Write everything of the summary as a JSON file too",
       .group = kGroup,
       .completes = kFile,
       .take = into(options.json)},
      {.kind = kFlag,
       .name = "quiet",
       .help = "Print nothing but errors",
       .group = kGroup,
       .take = into(options.quiet)},
      {.name = "config",
       .value = "FILE.yaml",
       .help = "Take options from a YAML file, by their long names (input: bay.poly, area: 5000, output: [a.vtu]); "
               "what the command line gives wins",
       .completes = kFile,
       .take = into(options.config)}};
}

}  // namespace

std::vector<Option> mesh_options(MeshOptions& options) {
  std::vector<Option> all{{.kind = Option::Kind::kPositional,
                           .name = "input",
                           .value = "INPUT",
                           .help = "The domain: Triangle's .poly (its .node beside it), or .node",
                           .completes = kFile,
                           .take = into(options.input)}};
  for (auto&& group : {quality_options(options), limit_options(options), parts_options(options.parts),
                       balancing_options(options.parts), output_options(options)})
    all.insert(all.end(), group.begin(), group.end());
  return all;
}

void check_mesh_options(const MeshOptions& options) {
  if (options.input.empty()) throw cli::UsageError("INPUT is missing");
  if (options.parts.subdomains > 0 && !options.parts.decomposition.empty())
    throw cli::UsageError("--decomposition excludes --subdomains");
  check_sizing_options(options.sizing);
}

}  // namespace driftmesh::app
