#include "patch/area.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

#include "driftmesh/id_vector.hpp"
#include "geometry/predicates.hpp"

namespace driftmesh::patch {
namespace {

using Corners = std::array<Point, 3>;

Corners corners_of(const Mesh& mesh, std::size_t t) {
  const auto& [a, b, c] = mesh.triangles[t];
  return {mesh.points[to_index(a)], mesh.points[to_index(b)], mesh.points[to_index(c)]};
}

/// Whether the line along an edge of `one`, a counterclockwise polygon, or a segment there and back, has all of `other`
/// on its right. The interiors have a point in common if none of either has.
template <class One, class Other>
bool is_apart(const One& one, const Other& other) {
  for (std::size_t i = 0; i < one.size(); ++i) {
    const Point &a = one[i], &b = one[(i + 1) % one.size()];
    if (std::ranges::all_of(other, [&](const Point& p) { return orient2d(a, b, p) <= 0; })) return true;
  }
  return false;
}

struct Side {
  Point a, b;
};

/// An area, by its sides in stripes of equal height.
class Stripes {
 public:
  explicit Stripes(std::vector<Side> sides) : sides_(std::move(sides)) {
    for (const Side& side : sides_) {
      box_.extend(side.a);
      box_.extend(side.b);
    }
    stripes_.resize(std::max<std::size_t>(1, sides_.size()));
    for (std::size_t i = 0; i < sides_.size(); ++i)
      for (std::size_t k = stripe(std::min(sides_[i].a.y, sides_[i].b.y));
           k <= stripe(std::max(sides_[i].a.y, sides_[i].b.y)); ++k)
        stripes_[k].push_back(i);
  }

  [[nodiscard]] bool overlaps(const Corners& t) const {
    const Box box = Box::of(t);
    if (!box.overlaps(box_)) return false;
    const Point middle{(t[0].x + t[1].x + t[2].x) / 3, (t[0].y + t[1].y + t[2].y) / 3};
    if (holds(middle)) return true;
    for (std::size_t k = stripe(box.low.y); k <= stripe(box.high.y); ++k)
      for (const std::size_t i : stripes_[k])
        if (enters(sides_[i], t)) return true;
    return false;
  }

 private:
  [[nodiscard]] std::size_t stripe(double y) const {
    const double share = (y - box_.low.y) / (box_.high.y - box_.low.y);
    const double last = static_cast<double>(stripes_.size() - 1);
    return static_cast<std::size_t>(std::clamp(share * static_cast<double>(stripes_.size()), 0.0, last));
  }
  /// By the number of sides to the right of the point.
  [[nodiscard]] bool holds(const Point& p) const {
    if (!box_.contains(p)) return false;
    bool odd = false;
    for (const std::size_t i : stripes_[stripe(p.y)]) {
      const auto& [a, b] = sides_[i];
      if ((a.y > p.y) == (b.y > p.y)) continue;
      if ((orient2d(a, b, p) > 0) == (b.y > a.y)) odd = !odd;
    }
    return odd;
  }
  /// Whether a part of the side is in the interior of the triangle.
  static bool enters(const Side& side, const Corners& t) {
    const std::array<Point, 2> ends{side.a, side.b};
    return !is_apart(t, ends) && !is_apart(ends, t);
  }

  std::vector<Side> sides_;
  Box box_;
  std::vector<std::vector<std::size_t>> stripes_;
};

/// One for each polygon, or one for all segments.
std::vector<Stripes> areas_of(const Pslg& pslg) {
  std::vector<Stripes> areas;
  const auto side = [&](std::int32_t a, std::int32_t b) {
    return Side{pslg.points[to_index(a)], pslg.points[to_index(b)]};
  };
  std::vector<Side> sides;
  for (const Pslg::Polygon& polygon : pslg.polygons) {
    sides.clear();
    for (const Pslg::Ring& ring : polygon.rings)
      for (std::size_t i = 0; i < ring.size(); ++i) sides.push_back(side(ring[i], ring[(i + 1) % ring.size()]));
    areas.emplace_back(sides);
  }
  if (!areas.empty()) return areas;
  for (const Pslg::Segment& s : pslg.segments) sides.push_back(side(s.a, s.b));
  areas.emplace_back(std::move(sides));
  return areas;
}

}  // namespace

std::vector<bool> triangles_in(const Mesh& mesh, const Box& box) {
  const std::array<Point, 4> frame{box.low, {box.high.x, box.low.y}, box.high, {box.low.x, box.high.y}};
  std::vector<bool> inside(mesh.triangles.size(), false);
  for (std::size_t t = 0; t < inside.size(); ++t) {
    const Corners corners = corners_of(mesh, t);
    inside[t] = Box::of(corners).overlaps(box) && !is_apart(frame, corners) && !is_apart(corners, frame);
  }
  return inside;
}

std::vector<bool> triangles_in(const Mesh& mesh, const Pslg& polygons) {
  const std::vector<Stripes> areas = areas_of(polygons);
  std::vector<bool> inside(mesh.triangles.size(), false);
  for (std::size_t t = 0; t < inside.size(); ++t) {
    const Corners corners = corners_of(mesh, t);
    inside[t] = std::ranges::any_of(areas, [&](const Stripes& area) { return area.overlaps(corners); });
  }
  return inside;
}

std::vector<bool> triangles_of_region(const Mesh& mesh, double attribute) {
  std::vector<bool> inside(mesh.triangles.size(), false);
  for (std::size_t t = 0; t < mesh.regions.size(); ++t) inside[t] = mesh.regions[t] == attribute;
  return inside;
}

}  // namespace driftmesh::patch
