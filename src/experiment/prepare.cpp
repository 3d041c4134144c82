#include "experiment/prepare.hpp"

#include <utility>

#include "base/error.hpp"
#include "decompose/decomposition_file.hpp"
#include "decompose/work.hpp"
#include "geometry/triangle_geometry.hpp"
#include "mesh/cdt.hpp"
#include "mesh/corners.hpp"
#include "mesh/mesher.hpp"
#include "pslg/generators.hpp"
#include "pslg/poly_file.hpp"
#include "pslg/repair.hpp"
#include "runtime/plan_run.hpp"

namespace driftmesh::experiment {
namespace {

double area_of(const Triangulation& mesh) {
  double area = 0;
  for (const Triangle& t : mesh.triangles)
    if (t.alive())
      area += signed_area(mesh.points[Triangulation::id(t.vertex[0])], mesh.points[Triangulation::id(t.vertex[1])],
                          mesh.points[Triangulation::id(t.vertex[2])]);
  return area;
}

/// The area bound that an experiment asks for on this domain; 0: none.
double area_bound_of(const Experiment& e, const Triangulation& mesh, std::size_t ranks) {
  const double triangles = e.triangles > 0 ? e.triangles : e.triangles_per_rank * static_cast<double>(ranks);
  return triangles > 0 ? kTrianglesPerBound * area_of(mesh) / triangles : e.area;
}

Decomposition decomposition_of(const Experiment& e, const Prepared& run, const Triangulation& mesh,
                               std::int32_t ranks) {
  if (!e.decomposition_file.empty()) return read_decomposition(e.decomposition_file, run.pslg);
  DecomposeOptions cutting;
  const std::int64_t of_all = std::int64_t{e.subdomains_per_rank} * ranks;
  cutting.subdomains =
      e.subdomains > 0 ? e.subdomains : static_cast<std::int32_t>(std::min<std::int64_t>(of_all, INT32_MAX));
  cutting.min_angle = e.separator_angle;
  cutting.bounds = run.plan.bounds;
  cutting.skew = e.skew;
  cutting.seed = static_cast<std::uint64_t>(e.seed);
  return decompose_for(mesh, cutting, ranks);
}

Balancing balancing_of(const Experiment& e) {
  Balancing balancing;
  balancing.policy = e.policy;
  balancing.parameters = parameters_of_policy(e);
  balancing.options.look = e.balance_look;
  balancing.options.gap = e.balance_gap;
  balancing.options.interval = e.balance_interval;
  balancing.options.worth.gain = e.balance_gain;
  if (e.cluster == "simulated") {
    balancing.options.cost.latency = e.latency + 2 * e.message_overhead;
    balancing.options.cost.bandwidth = e.bandwidth;
  }
  return balancing;
}

}  // namespace

SizingOptions sizing_of(const Experiment& e) {
  SizingOptions sizing;
  sizing.expression = e.size_expression;
  sizing.background = e.size_background;
  if (e.size_gradation > 0) sizing.gradation = e.size_gradation;
  sizing.shortest = e.size_shortest;
  if (e.size_longest > 0) sizing.longest = e.size_longest;
  return sizing;
}

std::string input_name(const Experiment& e) {
  if (!e.input_file.empty()) return e.input_file;
  std::string name = e.generator;
  for (const auto& [parameter, value] : e.generator_parameters) name += " --" + parameter + " " + value;
  return name;
}

Prepared prepare(const Experiment& e, const std::vector<double>& speeds) {
  Prepared run;
  run.pslg = e.input_file.empty() ? generate(e.generator, e.generator_parameters) : read_poly(e.input_file);
  run.repairs = repair(run.pslg, input_name(e));
  Triangulation mesh = triangulate(run.pslg);
  run.acute_corners = prepare_corners(mesh);
  run.size = make_size_field(sizing_of(e));
  MeshRequest request;
  request.min_angle = e.angle;
  request.max_area = area_bound_of(e, mesh, speeds.size());
  request.region_areas = e.region_areas;
  request.size = run.size.get();
  run.plan.bounds = bounds_of(run.pslg, request);
  PlanOptions options;
  options.mapping.ranks = static_cast<std::int32_t>(speeds.size());
  options.mapping.method = mapping_method(e.mapping);
  if (e.mapping_by_area) options.mapping.weight = MappingWeight::kArea;
  if (e.mapping_by_speed) options.mapping.speeds = speeds;
  options.presplit = presplit_mode(e.presplit);
  options.aggregation = static_cast<std::size_t>(e.aggregation);
  options.slice = e.slice;
  options.order = work_order(e.order);
  options.balancing = balancing_of(e);
  run.plan = plan_run(decomposition_of(e, run, mesh, options.mapping.ranks), run.plan.bounds, options);
  for (const Decomposition::Subdomain& s : run.plan.decomposition.subdomains) run.forecast += s.predicted;
  return run;
}

}  // namespace driftmesh::experiment
