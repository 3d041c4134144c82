// How well the work of subdomains is forecast: triangles made over triangles forecast, by subdomain.
//   driftmesh_bench_forecast [-n SUBDOMAINS] [FILE.poly ...]      (default: -n 200, and generated inputs)
//
// "cut": the forecast by which the domain is cut, known from the start; "own": the one that a subdomain makes of its
// triangulation when it starts. Each with the total over that forecast, and the coefficient of variation. "most/mean"
// is of the mesh, and "cost" the time of the forecast over that of the triangulation.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "base/stopwatch.hpp"
#include "decompose/decompose.hpp"
#include "driftmesh/error.hpp"
#include "driftmesh/generate.hpp"
#include "driftmesh/repair.hpp"
#include "mesh/cdt.hpp"
#include "mesh/corners.hpp"
#include "mesh/forecast.hpp"
#include "migration/subdomain.hpp"
#include "pslg/poly_file.hpp"

using namespace driftmesh;

namespace {

struct Ratios {
  double total = 0;      // ratio of the sums
  double variation = 0;  // standard deviation over mean
};

Ratios ratios(const std::vector<double>& made, const std::vector<double>& forecast) {
  double all_made = 0, all_forecast = 0, sum = 0, squares = 0;
  for (std::size_t i = 0; i < made.size(); ++i) {
    all_made += made[i];
    all_forecast += forecast[i];
    sum += made[i] / forecast[i];
    squares += made[i] / forecast[i] * made[i] / forecast[i];
  }
  const double mean = sum / static_cast<double>(made.size());
  return {all_made / all_forecast,
          std::sqrt(std::max(0.0, squares / static_cast<double>(made.size()) - mean * mean)) / mean};
}

/// Refines all subdomains as one rank would.
void refine_all(std::vector<Subdomain>& subdomains, const Decomposition& d) {
  std::vector<SplitPoint<GlobalRootId>> said;
  const auto is_active = [](const Subdomain& s) { return s.active(); };
  while (std::ranges::any_of(subdomains, is_active))
    for (Subdomain& s : subdomains) {
      if (!s.active()) continue;
      said.clear();
      s.work(std::numeric_limits<std::int64_t>::max(), said);
      for (const auto& split : said) subdomains[to_index(d.roots[split.root].across_from(s.id()))].tell(split);
    }
}

double median_seconds(auto&& work) {
  std::vector<double> times;
  for (int i = 0; i < 5; ++i) {
    const Stopwatch watch;
    work();
    times.push_back(watch.seconds());
  }
  std::ranges::nth_element(times, times.begin() + 2);
  return times[2];
}

double domain_area(const Triangulation& mesh) {
  double area = 0;
  for (const TriangleId t : ids_of(mesh.triangles))
    if (mesh.triangles[t].alive()) area += signed_area(mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2));
  return area;
}

/// `triangles`: about as many as the bound on area asks for; 0: no bound.
void print_row(const std::string& name, const Pslg& pslg, double angle, double triangles, int n) {
  Triangulation mesh = triangulate(pslg);
  const double seconds = median_seconds([&] { mesh = triangulate(pslg); });
  prepare_corners(mesh, {angle, false});
  DecomposeOptions options;
  options.subdomains = n;
  options.bounds.min_angle = angle;
  if (triangles > 0) options.bounds.plain.area = 1.55 * domain_area(mesh) / triangles;
  const double cost = median_seconds([&] { static_cast<void>(forecast_triangles(mesh, options.bounds)); }) / seconds;
  const Decomposition d = decompose(mesh, options);
  const SubdomainContext context{&d, options.bounds, triangles > 0};
  std::vector<Subdomain> subdomains;
  std::vector<double> made, cut, own;
  for (const SubdomainId i : ids_of(d.subdomains)) {
    Subdomain& s = subdomains.emplace_back(i, context);
    cut.push_back(s.remaining());
    std::vector<SplitPoint<GlobalRootId>> none;
    s.work(0, none);
    own.push_back(s.remaining() + static_cast<double>(s.triangles()));
  }
  refine_all(subdomains, d);
  for (const Subdomain& s : subdomains) made.push_back(static_cast<double>(s.triangles()));
  const Ratios by_cut = ratios(made, cut), by_own = ratios(made, own);
  double all = 0;
  for (const double m : made) all += m;
  std::printf("| %s | %.0f | %.0f | %d | %.0f | %.2f | %.1f | %.2f | %.1f | %.2f | %.2f |\n", name.c_str(), angle,
              triangles, n, all, by_cut.total, 100 * by_cut.variation, by_own.total, 100 * by_own.variation,
              *std::ranges::max_element(made) * n / all, cost);
}

}  // namespace

int main(int argc, char** argv) {
  int n = 200;
  std::vector<std::pair<std::string, Pslg>> inputs;
  try {
    for (int i = 1; i < argc; ++i)
      if (std::strcmp(argv[i], "-n") == 0 && i + 1 < argc)
        n = std::atoi(argv[++i]);
      else
        inputs.emplace_back(std::string(argv[i]).substr(std::string(argv[i]).find_last_of('/') + 1),
                            read_poly(argv[i]));
    if (inputs.empty())
      inputs = {{"generated pipe", generate_pipe({})},
                {"generated flow", generate_cylinder_flow({})},
                {"generated bay", generate_bay({})}};
    std::puts("| input | angle | by area | N | made | / cut | cv % | / own | cv % | most/mean | cost |");
    std::puts("|---|---|---|---|---|---|---|---|---|---|---|");
    for (auto& [name, pslg] : inputs) {
      repair(pslg, name);
      for (const double angle : {20.0, 30.0})
        for (const double triangles : {0.0, 50e3, 200e3}) print_row(name, pslg, angle, triangles, n);
    }
  } catch (const Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
