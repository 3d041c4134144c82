// The constants of CostModel, which determine virtual time: what the work of a rank takes on this machine.
//   driftmesh_bench_costs [REPETITIONS]      (default: 5)
//
// Each kind of work is timed over all subdomains of a domain in CPU time of this thread, so that other programs disturb
// little, and the minimum of the repetitions counts.

#include <malloc.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <limits>
#include <vector>

#include "driftmesh/error.hpp"
#include "driftmesh/generate.hpp"
#include "mesh/cdt.hpp"
#include "mesh/corners.hpp"
#include "migration/subdomain.hpp"
#include "runtime/plan_run.hpp"

using namespace driftmesh;

namespace {

double thread_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

struct Costs {
  double subdomains = 0;
  double prepared = 0, prepare_seconds = 0;  // triangles before refinement
  double points = 0, refine_seconds = 0;
  double triangles = 0;
  double bytes = 0, pack_seconds = 0, unpack_seconds = 0;
};

struct Domain {
  Triangulation mesh;
  DecomposeOptions cutting;
};

Domain domain_of(const Pslg& pslg, double area, std::int32_t subdomains) {
  Domain domain{triangulate(pslg), {}};
  prepare_corners(domain.mesh);
  domain.cutting.subdomains = subdomains;
  domain.cutting.bounds = {20, {area}, {}, nullptr};
  return domain;
}

RunPlan plan_of(const Pslg& pslg, double area, std::int32_t subdomains) {
  const Domain domain = domain_of(pslg, area, subdomains);
  return plan_run(decompose(domain.mesh, domain.cutting), domain.cutting.bounds, {});
}

/// Seconds for each subdomain and halving.
double cost_of_cutting(std::int32_t subdomains, int repetitions) {
  const Domain domain = domain_of(generate_pipe({}), 1e-3, subdomains);
  double best = std::numeric_limits<double>::infinity();
  for (int i = 0; i < repetitions; ++i) {
    const double begin = thread_seconds();
    static_cast<void>(decompose(domain.mesh, domain.cutting));
    best = std::min(best, thread_seconds() - begin);
  }
  return best / (subdomains * std::log2(subdomains));
}

Costs measure(const RunPlan& plan) {
  const SubdomainContext context{&plan.decomposition, plan.bounds, plan.presplit};
  Costs costs;
  std::vector<Subdomain> kept;  // as a rank keeps them
  std::vector<SplitPoint<GlobalRootId>> said;
  for (const SubdomainId i : ids_of(plan.decomposition.subdomains)) {
    Subdomain& subdomain = kept.emplace_back(i, context);
    const double begin = thread_seconds();
    const SliceWork start = subdomain.work(0, said);
    const double prepared = thread_seconds();
    double points = static_cast<double>(start.points);
    while (subdomain.active()) points += static_cast<double>(subdomain.work(plan.work.slice, said).points);
    costs.subdomains += 1;
    costs.prepared += static_cast<double>(start.prepared);
    costs.prepare_seconds += prepared - begin;
    costs.points += points;
    costs.refine_seconds += thread_seconds() - prepared;
    costs.triangles += static_cast<double>(subdomain.triangles());
  }
  for (const Subdomain& subdomain : kept) {
    const double begin = thread_seconds();
    const Bytes packed = subdomain.pack();
    const double was_packed = thread_seconds();
    const Subdomain again = Subdomain::unpack(packed, context);
    costs.pack_seconds += was_packed - begin;
    costs.unpack_seconds += thread_seconds() - was_packed;
    costs.bytes += static_cast<double>(packed.size());
  }
  return costs;
}

Costs best_of(const RunPlan& plan, int repetitions) {
  Costs best;
  best.prepare_seconds = best.refine_seconds = best.pack_seconds = best.unpack_seconds =
      std::numeric_limits<double>::infinity();
  for (int i = 0; i < repetitions; ++i) {
    malloc_trim(0);  // each starts with fresh pages, like a run
    Costs costs = measure(plan);
    costs.prepare_seconds = std::min(costs.prepare_seconds, best.prepare_seconds);
    costs.refine_seconds = std::min(costs.refine_seconds, best.refine_seconds);
    costs.pack_seconds = std::min(costs.pack_seconds, best.pack_seconds);
    costs.unpack_seconds = std::min(costs.unpack_seconds, best.unpack_seconds);
    best = costs;
  }
  return best;
}

void print_row(const char* name, const Costs& c) {
  std::printf("| %-22s | %6.0f | %8.1f | %8.1f | %9.1f | %9.2f | %6.3f | %6.3f |\n", name, c.subdomains,
              c.prepared / c.subdomains, 1e6 * c.prepare_seconds / c.subdomains, 1e9 * c.refine_seconds / c.points,
              1e-6 * c.triangles / c.refine_seconds, 1e9 * c.pack_seconds / c.bytes, 1e9 * c.unpack_seconds / c.bytes);
}

}  // namespace

int main(int argc, char** argv) {
  const int repetitions = argc > 1 ? std::atoi(argv[1]) : 5;
  if (argc > 2 || repetitions < 1) {
    std::fprintf(stderr, "usage: driftmesh_bench_costs [REPETITIONS]\n");
    return 2;
  }
  try {
    struct Case {
      const char* name;
      Pslg pslg;
      double area;
      std::int32_t subdomains;
    };
    // 2 million triangles each; subdomains of many and of few triangles distinguish `start` from `prepared`.
    const Case cases[] = {{"pipe, 50 subdomains", generate_pipe({}), 0.15, 50},
                          {"pipe, 200", generate_pipe({}), 0.15, 200},
                          {"pipe, 2000", generate_pipe({}), 0.15, 2000},
                          {"bay, 200", generate_bay({}), 2400, 200}};
    std::printf(
        "| %-22s | number | prepared | µs start | ns/point | million triangles/s | pack ns/byte | unpack ns/byte |\n",
        "subdomains");
    std::printf("|---|---|---|---|---|---|---|---|\n");
    std::vector<Costs> all;
    for (const Case& c : cases) {
      all.push_back(best_of(plan_of(c.pslg, c.area, c.subdomains), repetitions));
      print_row(c.name, all.back());
    }
    // Two unknowns from the extremes of the pipe: seconds per subdomain = start + prepared * triangles.
    const Costs &few = all[0], &many = all[2];
    const double x0 = few.prepared / few.subdomains, y0 = few.prepare_seconds / few.subdomains;
    const double x1 = many.prepared / many.subdomains, y1 = many.prepare_seconds / many.subdomains;
    const double slope = (y0 - y1) / (x0 - x1);
    std::printf(
        "\nin seconds: start %.3g, prepared %.3g, point %.3g, packed byte %.3g, unpacked byte %.3g (the last "
        "three: of pipe, 200)\n",
        y1 - slope * x1, slope, all[1].refine_seconds / all[1].points, all[1].pack_seconds / all[1].bytes,
        all[1].unpack_seconds / all[1].bytes);
    std::printf("cut %.3g with 2,880 subdomains, %.3g with 20,480, %.3g with 100,000\n",
                cost_of_cutting(2'880, repetitions), cost_of_cutting(20'480, repetitions),
                cost_of_cutting(100'000, repetitions));
  } catch (const Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
