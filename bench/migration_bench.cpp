// The cost of moving a subdomain relative to refining it, and the memory saved by sleep.
//   driftmesh_bench_migration [TRIANGLES ...]      (a subdomain; default: 2700 20000 100000)

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>
#include <vector>

#include "base/keep_memory.hpp"
#include "base/stopwatch.hpp"
#include "decompose/decompose.hpp"
#include "driftmesh/generate.hpp"
#include "mesh/cdt.hpp"
#include "mesh/corners.hpp"
#include "mesh/digest.hpp"
#include "migration/subdomain.hpp"

using namespace driftmesh;

namespace {

/// The average costs of a subdomain: seconds, bytes, triangles.
struct Costs {
  double refine = 0, pack = 0, unpack = 0, sleep = 0, wake = 0;
  double triangles = 0, packed_bytes = 0, dormant_bytes = 0;
  bool same = true;
};

template <class Work>
void add_time(double& seconds, Work&& work) {
  const Stopwatch watch;
  work();
  seconds += watch.seconds();
}

/// Packs and unpacks a subdomain while it is in the cache, as when a rank has just worked on it.
void move(Subdomain& subdomain, const SubdomainContext& context, Source source, Costs& costs) {
  Bytes packed;
  std::optional<Subdomain> moved;
  add_time(costs.pack, [&] { packed = subdomain.pack(); });
  add_time(costs.unpack, [&] { moved = Subdomain::unpack(packed, context, source); });
  costs.packed_bytes += static_cast<double>(packed.size());
  costs.same &= mesh_digest(moved->mesh().mesh) == mesh_digest(subdomain.mesh().mesh);
}

void sleep(Subdomain& subdomain, Costs& costs) {
  const std::uint64_t digest = mesh_digest(subdomain.mesh().mesh);
  add_time(costs.sleep, [&] { subdomain.sleep(); });
  costs.dormant_bytes += static_cast<double>(subdomain.dormant_mesh().bytes());
  add_time(costs.wake, [&] { subdomain.wake(); });
  costs.same &= mesh_digest(subdomain.mesh().mesh) == digest;
}

/// Refines every subdomain and calls `then` with it; returns the round whose refinement took the median time.
template <class Then>
Costs median_round(const SubdomainContext& context, Then&& then) {
  constexpr int kRounds = 11;
  std::vector<Costs> rounds(kRounds);
  for (Costs& costs : rounds) {
    for (const SubdomainId i : ids_of(context.decomposition->subdomains)) {
      Subdomain subdomain(i, context);
      std::vector<SplitPoint<GlobalRootId>> said;
      add_time(costs.refine, [&] { subdomain.work(INT64_MAX, said); });
      costs.triangles += static_cast<double>(subdomain.triangles());
      then(subdomain, costs);
    }
    for (double* sum : {&costs.refine, &costs.pack, &costs.unpack, &costs.sleep, &costs.wake, &costs.triangles,
                        &costs.packed_bytes, &costs.dormant_bytes})
      *sum /= static_cast<double>(context.decomposition->size());
  }
  std::nth_element(rounds.begin(), rounds.begin() + kRounds / 2, rounds.end(),
                   [](const Costs& a, const Costs& b) { return a.refine < b.refine; });
  return rounds[kRounds / 2];
}

void print_row(double wanted) {
  constexpr std::int32_t kSubdomains = 16;
  Triangulation mesh = triangulate(generate_pipe({}));
  prepare_corners(mesh);
  DecomposeOptions options;
  options.subdomains = kSubdomains;
  const Decomposition d = decompose(mesh, options);
  double area = 0;
  for (const auto& s : d.subdomains) area += s.area;
  SubdomainContext context{&d, {}, true};
  context.bounds.plain.area = area / (0.645 * wanted * kSubdomains);
  const Costs moved = median_round(context, [&](Subdomain& s, Costs& c) { move(s, context, Source::kThisRun, c); });
  const Costs checked = median_round(context, [&](Subdomain& s, Costs& c) { move(s, context, Source::kUnknown, c); });
  const Costs slept = median_round(context, [&](Subdomain& s, Costs& c) { sleep(s, c); });
  std::printf("| %.0f | %.2f | %.3f | %.3f | %.1f %% | %.3f | %.1f | %.3f | %.3f | %.1f | %s |\n", moved.triangles,
              1e3 * moved.refine, 1e3 * moved.pack, 1e3 * moved.unpack,
              100 * (moved.pack + moved.unpack) / moved.refine, 1e3 * checked.unpack,
              moved.packed_bytes / moved.triangles, 1e3 * slept.sleep, 1e3 * slept.wake,
              slept.dormant_bytes / slept.triangles, moved.same && checked.same && slept.same ? "yes" : "NO");
}

}  // namespace

int main(int argc, char** argv) {
  keep_freed_memory();
  std::vector<double> sizes;
  for (int i = 1; i < argc; ++i) sizes.push_back(std::atof(argv[i]));
  if (sizes.empty()) sizes = {2700, 20000, 100000};
  std::printf(
      "| triangles | refine ms | pack ms | unpack ms | pack + unpack | unpack, all checks, ms | bytes/triangle | "
      "sleep ms | wake ms | asleep, bytes/triangle | same mesh |\n");
  std::printf("| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n");
  for (const double size : sizes) print_row(size);
}
