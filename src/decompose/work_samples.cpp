#include "decompose/work_samples.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "decompose/work.hpp"
#include "geometry/predicates.hpp"
#include "mesh/bound_forecast.hpp"
#include "mesh/forecast.hpp"
#include "mesh/refiner.hpp"

namespace driftmesh {
namespace {

/// The expected number of triangles in a triangle of the coarse mesh: the average density times the area.
double work_in(const Triangulation& mesh, TriangleId t, const SizeBounds& sizes) {
  const Point &a = mesh.corner(t, 0), &b = mesh.corner(t, 1), &c = mesh.corner(t, 2);
  const double area = orient2d(a, b, c) / 2;
  const std::uint16_t region = mesh.region.empty() ? std::uint16_t{0} : mesh.region[t];
  const double least = 2 * kTrianglesPerBound / sizes.twice_area(region);
  double density = 0;
  for (const auto& [u, v, w] : {std::array<double, 3>{4, 1, 1}, {1, 4, 1}, {1, 1, 4}}) {
    const Point p{(u * a.x + v * b.x + w * c.x) / 6, (u * a.y + v * b.y + w * c.y) / 6};
    const double asked = std::max(least, 2 * kTrianglesPerBound / twice_area_of_edge(sizes.length_at(p)));
    const TimeStep* step = sizes.step();
    density +=
        step == nullptr ? asked : std::min(asked, 2 * kTrianglesPerBound / twice_area_of_edge(step->floor_at(p)));
  }
  return std::max(1.0, area * density / 3);
}

/// By a coarse mesh, graded as the fine one will be.
WorkSamples sample_sized(const Triangulation& mesh, double min_angle, const SizeBounds& sizes, double forecast,
                         double count) {
  Triangulation coarse = mesh;
  const double factor = std::max(1.0, forecast / count);
  Refiner refiner(coarse, min_angle, sizes.coarser(factor));
  refiner.limit_triangles(static_cast<std::int64_t>(20 * count + 10 * static_cast<double>(mesh.live_triangles())));
  refiner.refine();
  WorkSamples samples;
  for (const TriangleId t : ids_of(coarse.triangles)) {
    if (!coarse.triangles[t].alive()) continue;
    const Point &a = coarse.corner(t, 0), &b = coarse.corner(t, 1), &c = coarse.corner(t, 2);
    samples.push_back({{(a.x + b.x + c.x) / 3, (a.y + b.y + c.y) / 3}, work_in(coarse, t, sizes)});
  }
  return samples;
}

/// By the forecast; none if the details of the input add little to what the bounds on area ask for, or if the triangles
/// are so few that most of them will be there because of the separators.
WorkSamples sample_detailed(const Triangulation& mesh, const QualityBounds& bounds, double total, double count) {
  constexpr double kLittle = 1.01;
  if (total < count || !std::isfinite(total) || total <= kLittle * BoundForecast(mesh, bounds).asked()) return {};
  WorkSamples samples;
  Forecast(mesh, bounds).visit_samples(total / count, [&](const Point& at, double work) {
    samples.push_back({at, work});
  });
  return samples;
}

/// For the samples whose ray to the right meets the edge.
template <class Visit>
void for_each_crossing(std::span<const WorkSample> samples, const Point& a, const Point& b, Visit&& visit) {
  const bool up = a.y < b.y;
  const Point &low = up ? a : b, &high = up ? b : a;
  const double dx = high.x - low.x, dy = high.y - low.y;
  const auto below = [](const WorkSample& s, double y) { return s.at.y < y; };
  // Few samples, if any, lie between the ends of most edges.
  for (auto s = std::lower_bound(samples.begin(), samples.end(), low.y, below); s != samples.end() && s->at.y < high.y;
       ++s)
    if (dx * (s->at.y - low.y) > (s->at.x - low.x) * dy) visit(*s, up);
}

}  // namespace

WorkSamples sample_work(const Triangulation& mesh, const QualityBounds& bounds, double forecast, double count) {
  const SizeBounds sizes = bounds;
  WorkSamples samples = sizes.by_place() ? sample_sized(mesh, bounds.min_angle, sizes, forecast, count)
                                         : sample_detailed(mesh, bounds, forecast, count);
  std::sort(samples.begin(), samples.end(), [](const WorkSample& p, const WorkSample& q) {
    return p.at.y != q.at.y ? p.at.y < q.at.y : p.at.x < q.at.x;
  });
  return samples;
}

double work_of(const WorkSamples& samples) {
  double work = 0;
  for (const WorkSample& s : samples) work += s.work;
  return work;
}

double crossing_work(std::span<const WorkSample> samples, const Point& a, const Point& b) {
  double work = 0;
  for_each_crossing(samples, a, b, [&](const WorkSample& s, bool up) { work += up ? s.work : -s.work; });
  return work;
}

WorkSamples take_inside(WorkSamples& samples, std::span<const Point> border) {
  std::vector<char> inside(samples.size(), 0);
  for (std::size_t i = 0; i < border.size(); ++i)
    for_each_crossing(samples, border[i], border[i + 1 < border.size() ? i + 1 : 0],
                      [&](const WorkSample& s, bool) { inside[static_cast<std::size_t>(&s - samples.data())] ^= 1; });
  WorkSamples taken;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < samples.size(); ++i)
    if (inside[i] != 0)
      taken.push_back(samples[i]);
    else
      samples[kept++] = samples[i];
  samples.resize(kept);
  return taken;
}

WorkSamples thinned(const WorkSamples& samples, std::size_t most) {
  const std::size_t stride = (samples.size() + most - 1) / most;
  if (stride <= 1) return samples;
  WorkSamples some;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (i % stride == stride / 2) some.push_back({samples[i].at, 0});
    if (!some.empty()) some.back().work += samples[i].work;
  }
  return some;
}

}  // namespace driftmesh
