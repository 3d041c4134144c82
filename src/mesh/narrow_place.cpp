#include "mesh/narrow_place.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "geometry/triangle_geometry.hpp"
#include "mesh/channel.hpp"

namespace driftmesh {
namespace {

/// Measured at an angle bound of 20 degrees, for parallel segments of equal length: 2.2 to 3.7.
constexpr double kTrianglesPerWidth = 3;
constexpr double kLeastTriangles = 30;  // triangles: not worth mentioning
constexpr double kLongestBase = 5;      // relative to the height of its triangle: shorter ones are in no such channel

/// A place, found from one of its two segments.
struct FoundPlace {
  SubsegmentId first, second;
  NarrowPlace place;
};

NarrowPlace place_in(const Channel& channel, const Point& a, const Point& b, double length) {
  const double overlap = channel.to - channel.from;
  const double at = channel.width_at(channel.from) < channel.width_at(channel.to) ? channel.from : channel.to;
  const double near = channel.least_width(),
               far = std::max(channel.width_at(channel.from), channel.width_at(channel.to));
  // The integral of 1 / width.
  const double growth = far / near - 1;
  const double widths = overlap / near * (growth > 1e-6 ? std::log1p(growth) / growth : 1);
  const double share = at / length;
  return {{a.x + share * (b.x - a.x), a.y + share * (b.y - a.y)}, near, overlap, kTrianglesPerWidth * widths};
}

void add_places_at(const Triangulation& mesh, HalfEdge base, std::vector<FoundPlace>& found) {
  const Point &a = mesh.points[mesh.edge_start(base)], &b = mesh.points[mesh.edge_end(base)];
  const double squared = squared_distance(a, b);
  if (kLongestBase * 2 * signed_area(a, b, mesh.points[mesh.apex(base)]) > squared) return;
  const double length = std::sqrt(squared);
  const SubsegmentId segment = subsegment_of(mesh.twin(base));
  const Facing facing = facing_segments(mesh, base, length);
  if (facing.same_shell) return;
  for (int i = 0; i < facing.count; ++i) {
    const NarrowPlace place = place_in(facing.channels[i], a, b, length);
    const auto [first, second] = std::minmax(segment, facing.segments[i]);
    if (place.triangles > kLeastTriangles) found.push_back({first, second, place});
  }
}

/// Keeps the place with most triangles among several for the same two segments.
void keep_one_for_each_pair(std::vector<FoundPlace>& found) {
  std::sort(found.begin(), found.end(), [](const FoundPlace& f, const FoundPlace& g) {
    return std::tuple(f.first, f.second, -f.place.triangles) < std::tuple(g.first, g.second, -g.place.triangles);
  });
  const auto same_pair = [](const FoundPlace& f, const FoundPlace& g) {
    return f.first == g.first && f.second == g.second;
  };
  found.erase(std::unique(found.begin(), found.end(), same_pair), found.end());
}

}  // namespace

std::vector<NarrowPlace> find_narrow_places(const Triangulation& mesh) {
  std::vector<FoundPlace> found;
  for (const TriangleId t : ids_of(mesh.triangles)) {
    if (!mesh.triangles[t].alive()) continue;
    for (int k = 0; k < 3; ++k)
      if (const HalfEdge h = half_edge(t, k); is_constrained(mesh.twin(h))) add_places_at(mesh, h, found);
  }
  keep_one_for_each_pair(found);
  std::vector<NarrowPlace> places;
  for (const FoundPlace& f : found) places.push_back(f.place);
  std::stable_sort(places.begin(), places.end(),
                   [](const NarrowPlace& p, const NarrowPlace& q) { return p.triangles > q.triangles; });
  return places;
}

std::optional<NarrowPlace> find_narrow_place(const Triangulation& mesh) {
  const std::vector<NarrowPlace> places = find_narrow_places(mesh);
  if (places.empty()) return std::nullopt;
  return places.front();
}

}  // namespace driftmesh
