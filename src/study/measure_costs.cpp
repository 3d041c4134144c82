#include "study/measure_costs.hpp"

#include <algorithm>
#include <vector>

#include "driftmesh/generate.hpp"
#include "mesh/cdt.hpp"
#include "mesh/corners.hpp"
#include "migration/subdomain.hpp"
#include "runtime/plan_run.hpp"
#include "study/thread_seconds.hpp"

namespace driftmesh::study {
namespace {

RunPlan pipe_plan(double area, std::int32_t subdomains) {
  Triangulation mesh = triangulate(generate_pipe({}));
  prepare_corners(mesh);
  const QualityBounds bounds{20, {area}, {}, nullptr};
  DecomposeOptions cutting;
  cutting.subdomains = subdomains;
  cutting.bounds = bounds;
  return plan_run(decompose_for(mesh, cutting, 1), bounds, {});
}

/// Seconds of work on all subdomains of a plan, and how much work that was.
struct Worked {
  double subdomains = 0;
  double prepared = 0, preparing = 0;  // triangles before refinement
  double points = 0, refining = 0;
  double bytes = 0, packing = 0;  // `packing` includes unpacking
};

template <class Action>
double seconds_of(const Action& action) {
  const double start = thread_seconds();
  action();
  return thread_seconds() - start;
}

Worked work_on(const RunPlan& plan) {
  const SubdomainContext context{&plan.decomposition, plan.bounds, plan.presplit};
  Worked sum;
  std::vector<Subdomain> kept;  // as a rank keeps them
  std::vector<SplitPoint<GlobalRootId>> said;
  for (const SubdomainId id : ids_of(plan.decomposition.subdomains)) {
    Subdomain& subdomain = kept.emplace_back(id, context);
    sum.subdomains += 1;
    sum.preparing += seconds_of([&] { sum.prepared += static_cast<double>(subdomain.work(0, said).prepared); });
    sum.refining += seconds_of([&] {
      while (subdomain.active()) sum.points += static_cast<double>(subdomain.work(plan.work.slice, said).points);
    });
  }
  for (const Subdomain& subdomain : kept)
    sum.packing += seconds_of([&] {
                     const Bytes packed = subdomain.pack();
                     sum.bytes += static_cast<double>(packed.size());
                     static_cast<void>(Subdomain::unpack(packed, context, Source::kThisRun));
                   }) /
                   2;
  return sum;
}

}  // namespace

// Subdomains of many and of few triangles tell what each one costs from what each of its triangles costs.
CostModel measure_costs(bool quick) {
  const double area = quick ? 15 : 0.15;
  const Worked few = work_on(pipe_plan(area, quick ? 5 : 50)), many = work_on(pipe_plan(area, quick ? 100 : 2000));
  const auto triangles = [](const Worked& w) { return w.prepared / w.subdomains; };
  const auto seconds = [](const Worked& w) { return w.preparing / w.subdomains; };
  CostModel costs;
  costs.prepared = std::max(0.0, (seconds(few) - seconds(many)) / (triangles(few) - triangles(many)));
  costs.start = std::max(0.0, seconds(many) - costs.prepared * triangles(many));
  costs.point = few.refining / few.points;
  costs.packed_byte = few.packing / few.bytes;
  costs.planning = measure_planning(quick);
  return costs;
}

}  // namespace driftmesh::study
