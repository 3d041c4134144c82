// What moving a subdomain costs against refining it, and what its sleep saves.
//   driftmesh_bench_migration [TRIANGLES ...]      (a subdomain; default: 2700 20000 100000)

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "base/keep_memory.hpp"
#include "base/stopwatch.hpp"
#include "decompose/decompose.hpp"
#include "mesh/cdt.hpp"
#include "mesh/corners.hpp"
#include "mesh/digest.hpp"
#include "migration/subdomain.hpp"
#include "pslg/generate.hpp"

using namespace driftmesh;

namespace {

struct Costs {
  std::vector<double> refine, pack, unpack, unpack_all, sleep, wake;  // seconds a subdomain, one entry a round
  double triangles = 0;                                               // mean of the subdomains
  double bytes = 0, dormant_bytes = 0;                                // of memory
  bool same = true;
};

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

/// Refines every subdomain, and packs and unpacks it while it lies in the cache as it does when a rank has worked on
/// it.
Costs measure(const SubdomainContext& context, int rounds) {
  Costs costs;
  const auto n = static_cast<SubdomainId>(context.decomposition->size());
  std::vector<protocol::SplitEntry> said;
  for (int round = 0; round < rounds; ++round) {
    double refine = 0, pack = 0, unpack = 0, unpack_all = 0, sleep = 0, wake = 0, triangles = 0, bytes = 0,
           dormant_bytes = 0;
    for (SubdomainId i = 0; i < n; ++i) {
      Subdomain subdomain(i, context);
      said.clear();
      Stopwatch watch;
      subdomain.work(INT64_MAX, said);
      refine += watch.seconds();
      watch = Stopwatch();
      const protocol::Bytes packed = subdomain.pack();
      pack += watch.seconds();
      const bool check_all = round % 2 != 0;
      watch = Stopwatch();
      const Subdomain again = Subdomain::unpack(packed, context, check_all ? Source::kUnknown : Source::kThisRun);
      (check_all ? unpack_all : unpack) += watch.seconds();
      watch = Stopwatch();
      subdomain.sleep();
      sleep += watch.seconds();
      dormant_bytes += static_cast<double>(subdomain.dormant_mesh().bytes());
      watch = Stopwatch();
      subdomain.wake();
      wake += watch.seconds();
      triangles += static_cast<double>(again.triangles());
      bytes += static_cast<double>(packed.size());
      if (round == 0) costs.same &= mesh_digest(again.mesh().mesh) == mesh_digest(subdomain.mesh().mesh);
    }
    costs.refine.push_back(refine / n);
    costs.pack.push_back(pack / n);
    if (unpack > 0) costs.unpack.push_back(unpack / n);
    if (unpack_all > 0) costs.unpack_all.push_back(unpack_all / n);
    costs.sleep.push_back(sleep / n);
    costs.wake.push_back(wake / n);
    costs.dormant_bytes = dormant_bytes / n;
    costs.triangles = triangles / n;
    costs.bytes = bytes / n;
  }
  return costs;
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
  context.bounds.max_area = area / (0.645 * wanted * kSubdomains);
  const Costs c = measure(context, 20);
  const double refine = median(c.refine), pack = median(c.pack), unpack = median(c.unpack),
               unpack_all = median(c.unpack_all);
  std::printf("| %.0f | %.2f | %.3f | %.3f | %.1f %% | %.3f | %.1f | %.3f | %.3f | %.1f | %s |\n", c.triangles,
              1e3 * refine, 1e3 * pack, 1e3 * unpack, 100 * (pack + unpack) / refine, 1e3 * unpack_all,
              c.bytes / c.triangles, 1e3 * median(c.sleep), 1e3 * median(c.wake), c.dormant_bytes / c.triangles,
              c.same ? "yes" : "NO");
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
