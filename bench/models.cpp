#include "bench/models.hpp"

#include <algorithm>
#include <random>
#include <utility>

#include "base/narrow.hpp"
#include "bench/cgal_mesher.hpp"
#include "pslg/generate.hpp"
#include "pslg/poly_file.hpp"

namespace driftmesh::bench {
namespace {

/// Adds a closed loop through `corners`.
void add_loop(Pslg& pslg, const std::vector<Point>& corners) {
  const auto first = narrow<std::int32_t>(pslg.points.size(), "points");
  const auto count = narrow<std::int32_t>(corners.size(), "corners");
  pslg.points.insert(pslg.points.end(), corners.begin(), corners.end());
  for (std::int32_t i = 0; i < count; ++i) pslg.segments.push_back({first + i, first + (i + 1) % count, 1});
}

Model with_area(const std::string& name, Pslg pslg) {
  const double area = domain_area(pslg);
  return {name, std::move(pslg), area};
}

}  // namespace

std::vector<Model> load_models(const std::filesystem::path& folder) {
  const auto load = [&](const std::string& name, const std::string& substitute, const auto& generate) {
    const std::filesystem::path path = folder / (name + ".poly");
    return std::filesystem::exists(path) ? with_area(name, read_poly(path.string()))
                                         : with_area(substitute, generate());
  };
  return {load("pipe", "generated pipe", [] { return generate_pipe({}); }),
          load("cylinder_flow", "generated cylinder flow", [] { return generate_cylinder_flow({}); }),
          load("chesapeake", "generated bay", [] { return generate_bay({}); }),
          with_area("rectangle with a hole", generate_rectangle_hole({}))};
}

Pslg points_with_chains(std::size_t points, std::size_t segments, std::uint64_t seed) {
  constexpr std::size_t kStrips = 100;
  Pslg pslg;
  add_loop(pslg, {{0, 0}, {1, 0}, {1, 1}, {0, 1}});
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  const std::size_t in_strip = points / kStrips;
  const std::size_t in_chain = segments / kStrips + 1;  // points of one chain
  for (std::size_t strip = 0; strip < kStrips; ++strip) {
    const std::size_t first = pslg.points.size();
    for (std::size_t i = 0; i < in_strip; ++i) {
      const double x = unit(random);
      pslg.points.push_back({x, (static_cast<double>(strip) + unit(random)) / kStrips});
    }
    // Every few points, left to right, are joined: such segments miss the Delaunay triangulation and must be forced.
    std::sort(pslg.points.begin() + static_cast<std::ptrdiff_t>(first), pslg.points.end(),
              [](const Point& a, const Point& b) { return a.x < b.x; });
    const std::size_t step = in_strip / in_chain;
    for (std::size_t i = 0; i + 1 < in_chain; ++i) {
      const auto a = narrow<std::int32_t>(first + i * step, "point");
      pslg.segments.push_back({a, narrow<std::int32_t>(first + (i + 1) * step, "point"), 2});
    }
  }
  return pslg;
}

}  // namespace driftmesh::bench
