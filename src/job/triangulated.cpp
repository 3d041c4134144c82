#include "job/triangulated.hpp"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "base/formatted.hpp"
#include "base/words.hpp"
#include "geometry/triangle_geometry.hpp"
#include "job/value.hpp"
#include "mesh/area_for_count.hpp"
#include "mesh/cdt.hpp"
#include "mesh/corners.hpp"
#include "mesh/domain_warnings.hpp"
#include "mesh/forecast.hpp"
#include "mesh/narrow_place.hpp"
#include "mesh/size_bound.hpp"

namespace driftmesh::job {
namespace {

/// How many triangles are wanted; 0: it is not said.
double wanted_triangles(const Request::Bounds& bounds, std::int32_t ranks) {
  return bounds.triangles > 0 ? bounds.triangles : bounds.triangles_per_rank * ranks;
}

QualityBounds bounds_of(const Request& request, const Domain& domain, const Triangulation& mesh, double wanted) {
  QualityBounds bounds{.min_angle = request.bounds.angle,
                       .plain = request.bounds,
                       .size = domain.size.get(),
                       .step = domain.step.get(),
                       .rules = domain.rules};
  if (bounds.plain.region_areas) bounds.region_max_area = areas_by_region(domain.pslg);
  if (wanted > 0) bounds.plain.area = area_for_count(mesh, bounds, wanted);
  return bounds;
}

/// Where what is asked for besides takes more triangles than are wanted.
std::vector<std::string> count_warnings(double wanted, double forecast) {
  constexpr double kMuch = 1.1;
  if (forecast <= kMuch * wanted) return {};
  return {
      formatted("{} triangles are wanted, but angles, sizes and the details of the input take about {}; allow "
                "smaller angles, ask for greater lengths, or have details removed (simplify)",
                estimate_words(wanted), estimate_words(forecast))};
}

/// One place where the background mesh does not say what size is asked for, if there is one.
std::vector<std::string> background_warnings(const Domain& domain, const Triangulation& mesh) {
  if (domain.background == nullptr) return {};
  for (const TriangleId t : ids_of(mesh.triangles)) {
    if (!mesh.triangles[t].alive()) continue;
    if (const auto place = domain.background->uncovered({mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2)}))
      return {"the background mesh does not cover the domain, for example not at (" + shortest_text(place->x) + ", " +
              shortest_text(place->y) + "); outside it the sizes at the nearest point of its boundary apply"};
  }
  return {};
}

/// The edge length that the bounds ask for there, outside all regions.
double asked_edge(const SizeBounds& sizes, const Point& at) {
  const double by_area = edge_of_twice_area(sizes.twice_area(0));
  return sizes.by_place() ? std::min(by_area, sizes.length_at(at)) : by_area;
}

/// Distances between segments that cost many triangles, unless the bounds ask for as small ones there.
std::vector<std::string> narrow_warnings(const Triangulation& mesh, const QualityBounds& bounds, double forecast) {
  constexpr double kMany = 10'000;
  if (bounds.min_angle == 0) return {};
  const SizeBounds sizes = bounds;
  std::vector<NarrowPlace> places = find_narrow_places(mesh);
  std::erase_if(places, [&](const NarrowPlace& place) { return asked_edge(sizes, place.at) <= place.width; });
  if (places.empty()) return {};
  double all = 0;
  for (const NarrowPlace& place : places) all += place.triangles;
  const NarrowPlace& worst = places.front();
  if (worst.triangles < kMany && (all < kMany || all < forecast / 2)) return {};
  const std::string others =
      places.size() == 1 ? "" : formatted(", and {} for {} such places together", estimate_words(all), places.size());
  return {formatted(
      "near ({:.10g}, {:.10g}) two segments of the input that do not touch are {:.3g} apart and run side by side for "
      "{:.3g}, which takes about {} triangles at any area bound{}; move them apart there, or have the input snapped",
      worst.at.x, worst.at.y, worst.width, worst.length, estimate_words(worst.triangles), others)};
}

}  // namespace

Triangulated triangulate_domain(const Request& request, const Domain& domain, std::int32_t ranks, Cut cut,
                                Watch& watch) {
  Triangulated result;
  const double wanted = wanted_triangles(request.bounds, ranks);
  timed(watch, "triangulate", [&] {
    CarveReport carved;
    result.mesh = triangulate(domain.pslg, &carved);
    warn(request, domain_warnings(domain.pslg, domain.repairs, carved, result.mesh), watch);
    if (domain.pslg.polygons.empty())
      result.holes = domain.pslg.holes;
    else
      result.holes = std::move(carved.holes);
    warn(request, background_warnings(domain, result.mesh), watch);
    result.bounds = bounds_of(request, domain, result.mesh, wanted);
    const auto count = [&] { result.forecast = forecast_triangles(result.mesh, result.bounds); };
    // Where a bound on size says where their triangles will be. Depends on neither the machine nor the number of
    // threads.
    const bool if_large = cut == Cut::kIfLarge && SizeBounds(result.bounds).any();
    if (if_large) count();  // acute corners, not yet prepared, change little there
    result.cut = cut == Cut::kAlways || (if_large && is_worth_cutting(result.mesh, result.forecast));
    const std::size_t before = result.mesh.live_vertices();
    result.acute_corners =
        prepare_corners(result.mesh, result.cut ? CornerUse{} : CornerUse{request.bounds.angle, false, domain.rules});
    if (result.acute_corners > 0 && wanted > 0) result.bounds = bounds_of(request, domain, result.mesh, wanted);
    if (std::int64_t& most = result.bounds.rules.most_points; most != INT64_MAX)
      most -= static_cast<std::int64_t>(result.mesh.live_vertices() - before);
    if (!if_large || result.acute_corners > 0) count();
    if (wanted > 0) {
      const TriedArea tried = try_area_for_count(result.mesh, result.bounds, wanted, result.forecast);
      warn(request, count_warnings(wanted, tried.triangles), watch);
      if (std::exchange(result.bounds.plain.area, tried.area) != tried.area) count();
    }
    warn(request, narrow_warnings(result.mesh, result.bounds, result.forecast), watch);
  });
  return result;
}

}  // namespace driftmesh::job
