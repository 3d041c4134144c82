#include "app/mesh_options.hpp"

#include <CLI/CLI.hpp>

#include "app/cutting_options.hpp"
#include "app/sizing_options.hpp"
#include "app/validators.hpp"
#include "balancer/policies/policy_factory.hpp"
#include "decompose/decompose.hpp"

namespace driftmesh::app {
namespace {

std::string check_angle(const std::string& text) {
  double value = 0;
  if (CLI::detail::lexical_cast(text, value) && value >= 0 && value <= kMaxAngle) return {};
  return "'" + text + "' is not an angle from 0 to " + std::to_string(static_cast<int>(kMaxAngle)) +
         " degrees; above that refinement need not come to an end";
}

void add_quality_options(CLI::App& command, MeshOptions& options) {
  constexpr const char* kGroup = "Triangles (lengths and areas in the units of the input)";
  command.add_option("-a,--area", options.area, "No triangle is larger than this")
      ->check(positive())
      ->type_name("AREA")
      ->group(kGroup);
  command
      .add_option("-q,--angle", options.angle,
                  "No angle is smaller than this, in degrees, from 0 to 34, but for those that small angles of the "
                  "input force. Up to 25.6 refinement is proven to end; up to about 33 it does in practice, with more "
                  "triangles")
      ->check(CLI::Validator(check_angle, ""))
      ->capture_default_str()
      ->type_name("DEGREES")
      ->group(kGroup);
  add_sizing_options(command, options.sizing, kGroup);
  command.add_flag("--no-region-areas", options.no_region_areas, "Ignore the area bounds of the input's regions")
      ->group(kGroup);
}

void add_limit_options(CLI::App& command, MeshOptions& options) {
  constexpr const char* kGroup = "Limits";
  command
      .add_option("--max-triangles", options.max_triangles,
                  "Stop at this many triangles, or at once when more are to be expected; 50M is 50 million")
      ->transform(size_value(1000, static_cast<double>(MeshRequest{}.max_triangles)))
      ->type_name("N")
      ->group(kGroup);
  command
      .add_option("--max-memory", options.max_memory,
                  "Likewise for memory: 6G is 6 GiB  [90 % of what the machine has free]")
      ->transform(size_value(1024, 1e18))
      ->type_name("SIZE")
      ->group(kGroup);
  command
      .add_flag("--keep-incomplete", options.keep_incomplete,
                "Write what was made when a limit stops the work (not in subdomains)")
      ->group(kGroup);
}

void add_parts_options(CLI::App& command, MeshOptions::Parts& parts) {
  constexpr const char* kGroup = "Many ranks and subdomains (mpirun -n P driftmesh mesh ...)";
  CLI::Option* const count =
      command
          .add_option("-n,--subdomains", parts.subdomains,
                      "Cut the domain into so many subdomains, far more than ranks; works without mpirun, too  [20 a "
                      "rank, or what keeps a subdomain in cache]")
          ->check(CLI::Range(1, kMaxSubdomains).description(""))
          ->type_name("N")
          ->group(kGroup);
  command
      .add_option("--decomposition", parts.decomposition, "Take the subdomains from this file of driftmesh decompose")
      ->excludes(count)
      ->type_name("FILE")
      ->group(kGroup);
  add_cutting_options(command, {&parts.separator_angle, &parts.skew, &parts.seed}, kGroup);
  command
      .add_option("--mapping", parts.mapping,
                  "How subdomains are dealt to ranks at the start: graph (balanced, short interfaces), block or "
                  "round-robin")
      ->check(CLI::IsMember({"graph", "block", "round-robin"}).description(""))
      ->capture_default_str()
      ->type_name("HOW")
      ->group(kGroup);
  command
      .add_flag("--map-by-area", parts.map_by_area,
                "Deal out area instead of expected work: an uneven start, for experiments")
      ->group(kGroup);
  command
      .add_option("--speeds", parts.speeds,
                  "Relative speed of each rank, where known: work is dealt in proportion, as in --speeds 1,1,2.5")
      ->delimiter(',')
      ->check(positive())
      ->type_name("S,S,...")
      ->group(kGroup);
  command
      .add_option("--presplit", parts.presplit,
                  "Cut interfaces to size before refinement: off is the protocol in full, auto is on wherever a bound "
                  "on area or size says what size. On, and with one bound on area everywhere, the mesh depends on the "
                  "subdomains alone wherever the input has "
                  "no features that ask for more")
      ->check(CLI::IsMember({"auto", "on", "off"}).description(""))
      ->capture_default_str()
      ->type_name("MODE")
      ->group(kGroup);
  command.add_option("--aggregation", parts.aggregation, "Split points that travel together at most")
      ->check(CLI::Range(std::size_t{1}, std::size_t{1'000'000}).description(""))
      ->capture_default_str()
      ->type_name("K")
      ->group(kGroup);
  command
      .add_option("--order", parts.order,
                  "Which subdomain a rank refines next: given (neighbours together), largest or backlog")
      ->check(CLI::IsMember({"given", "largest", "backlog"}).description(""))
      ->capture_default_str()
      ->type_name("ORDER")
      ->group(kGroup);
  command
      .add_flag(
          "--sleep", parts.sleep,
          "Keep finished subdomains in about 10 bytes a triangle instead of 40, until a neighbour needs one again")
      ->group(kGroup);
}

void add_balancing_options(CLI::App& command, MeshOptions::Parts& parts) {
  constexpr const char* kGroup = "Balancing: subdomains move between ranks while they are refined";
  command
      .add_option(
          "--balance", parts.policy,
          "Who decides what moves: " + CLI::detail::join(balancer::policy_names(), ", ") + " (docs/balancing.md)")
      ->check(CLI::IsMember(balancer::policy_names()).description(""))
      ->capture_default_str()
      ->type_name("POLICY")
      ->group(kGroup);
  command
      .add_option("--balance-with", parts.policy_parameters,
                  "A parameter of the policy, as in --balance-with method=graph; can be given several times")
      ->allow_extra_args(false)
      ->type_name("NAME=VALUE")
      ->group(kGroup);
  command
      .add_option(
          "--drag", parts.drag,
          "For experiments: the fraction of its time that each rank works, as in --drag 1,0.5; it sleeps through "
          "the rest")
      ->delimiter(',')
      ->check(CLI::Range(0.01, 1.0).description(""))
      ->type_name("F,F,...")
      ->group(kGroup);
}

void add_output_options(CLI::App& command, MeshOptions& options) {
  constexpr const char* kGroup = "Output";
  command
      .add_option(
          "-o,--output", options.outputs,
          "Mesh file, by extension: .vtu (ParaView), .pvtu (the same in pieces, one a rank; in subdomains only), "
          ".msh (Gmsh 4.1), or .node, .ele, .poly, .edge, .neigh (any of them writes Triangle's whole set). Can be "
          "given several times; without it, the summary alone")
      ->allow_extra_args(false)  // one a time: what follows may be the input
      ->type_name("FILE")
      ->group(kGroup);
  command
      .add_option("--plot", options.picture, "Picture of the mesh: .png, .svg or .pdf (more: driftmesh plot --help)")
      ->type_name("FILE")
      ->group(kGroup);
  command.add_option("--json", options.json, "Write everything of the summary as a JSON file too")
      ->type_name("FILE")
      ->group(kGroup);
  command.add_flag("--quiet", options.quiet, "Print nothing but errors")->group(kGroup);
  command
      .add_option("--config", options.config,
                  "Take options from a YAML file, by their long names (input: bay.poly, area: 5000, output: [a.vtu]); "
                  "what the command line gives wins")
      ->type_name("FILE.yaml");
}

}  // namespace

void add_mesh_options(CLI::App& command, MeshOptions& options) {
  command.add_option("input", options.input, "The domain: Triangle's .poly (its .node beside it), or .node")
      ->type_name("");
  add_quality_options(command, options);
  add_limit_options(command, options);
  add_parts_options(command, options.parts);
  add_balancing_options(command, options.parts);
  add_output_options(command, options);
  command.footer(
      "Examples:\n"
      "  driftmesh mesh bay.poly --area 5000 -o bay.vtu --plot bay.png\n"
      "  driftmesh mesh bay.poly --angle 30 -o bay.msh -o bay.ele\n"
      "  driftmesh mesh bay.poly --size \"20 + 0.1*abs(x)\" --json run.json\n"
      "  mpirun -n 4 driftmesh mesh bay.poly --area 50 -o bay.pvtu\n"
      "Check a mesh with: driftmesh check bay.vtu bay.poly --angle 20 --area 5000\n"
      "Exit code: 0 done, 1 error, 2 wrong usage, 3 stopped by a limit.");
}

void check_mesh_options(const MeshOptions& options) {
  if (options.input.empty()) throw CLI::RequiredError("INPUT.poly");
  check_sizing_options(options.sizing);
}

}  // namespace driftmesh::app
