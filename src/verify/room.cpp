#include "verify/room.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "driftmesh/id_vector.hpp"
#include "geometry/midpoint.hpp"
#include "geometry/predicates.hpp"
#include "verify/extended.hpp"

namespace driftmesh {
namespace {

// In spacings of doubles at the place:
constexpr double kNeighbors = 2;  // no edge longer: nothing between the corners
constexpr double kNarrow = 2;     // rounding moves a midpoint, and moved the ends, by up to 0.71 each
constexpr double kShort = 256;    // subsegments: the room that refinement needs beside a vertex

/// Fraction of a segment, with some rounding: a shorter subsegment is not split.
constexpr long double kDeepest = 0x1p-60L * (1 + 1e-9L);

/// The spacing of doubles of the size of the larger coordinate.
double spacing_at(const Point& p) {
  const double size = std::max(std::fabs(p.x), std::fabs(p.y));
  return std::nextafter(size, std::numeric_limits<double>::infinity()) - size;
}

long double distance(const Point& a, const Point& b) {
  return std::sqrt(dot_extended(a, b, b));
}

/// The bounding box of the diametral circle.
Box box_around(const Point& a, const Point& b) {
  const Point m = midpoint(a, b);
  return Box::around(m, m, static_cast<double>(distance(a, b) / 2) * (1 + 1e-9) + 2 * spacing_at(m));
}

bool in_diametral_circle(const Point& p, const Point& a, const Point& b) {
  return dot_extended(p, a, b) <= 0;
}

bool cross(const Point& p, const Point& q, const Point& a, const Point& b) {
  const auto apart = [](long double u, long double v) { return (u < 0 && v > 0) || (u > 0 && v < 0); };
  return apart(cross_extended(a, b, p), cross_extended(a, b, q)) &&
         apart(cross_extended(p, q, a), cross_extended(p, q, b));
}

}  // namespace

Room::Room(const Mesh& mesh, const Chains& chains) : mesh_(mesh), subsegments_(chains.subsegments()) {
  for (const Chains::Chain& chain : chains.all()) {
    const Point &first = mesh.points[chain.vertices.front()], &last = mesh.points[chain.vertices.back()];
    for (const std::int32_t s : chain.subsegments) add_stuck(s, distance(first, last) * kDeepest);
  }
  std::vector<Box> boxes;
  for (const Segment& s : stuck_) boxes.push_back(box_around(s.a, s.b));
  tree_ = BoxTree(boxes);
}

void Room::add_stuck(std::int32_t subsegment, long double shortest) {
  const Mesh::Edge& edge = subsegments_[subsegment];
  const Point &a = mesh_.points[edge.a], &b = mesh_.points[edge.b];
  if (distance(a, b) <= shortest || is_stuck(subsegment)) stuck_.push_back({a, b});
}

bool Room::is_stuck(std::int32_t subsegment) const {
  const Mesh::Edge& edge = subsegments_[subsegment];
  const Point &a = mesh_.points[edge.a], &b = mesh_.points[edge.b], m = midpoint(a, b);
  if (m == a || m == b) return true;
  for (const std::int32_t t : {subsegments_.left(subsegment, edge.a), subsegments_.right(subsegment, edge.a)}) {
    if (t == kNone) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int32_t apex = mesh_.triangles[t][k];
      if (apex == edge.a || apex == edge.b ||
          (distance(a, b) > kShort * spacing_at(m) && subsegments_.at(apex).empty()))
        continue;
      const Point& c = mesh_.points[apex];
      if (std::fabs(cross_extended(a, b, c)) <= kNarrow * spacing_at(c) * distance(a, b)) return true;
    }
  }
  return false;
}

bool Room::none_for_angle(const Triangle& t, double min_angle) const {
  return none_for(t, 0.5 / std::tan(min_angle * (std::numbers::pi / 360)));
}

bool Room::none_for_area(const Triangle& t) const {
  return none_for(t, std::numeric_limits<double>::infinity());
}

// The point that helps lies on the bisector of the shortest edge, at the circumcenter but no farther off than the given
// multiple of the edge.
bool Room::none_for(const Triangle& t, double most_height) const {
  std::array<long double, 3> opposite{};
  for (std::size_t k = 0; k < 3; ++k) opposite[k] = distance(t[(k + 1) % 3], t[(k + 2) % 3]);
  const std::size_t apex = std::min_element(opposite.begin(), opposite.end()) - opposite.begin();
  const Point &a = t[(apex + 1) % 3], &b = t[(apex + 2) % 3], &c = t[apex];
  if (*std::max_element(opposite.begin(), opposite.end()) <= kNeighbors * spacing_at(c)) return true;
  const auto height = std::min(static_cast<double>(dot_extended(c, a, b) / (2 * cross_extended(c, a, b))), most_height);
  const double ex = b.x - a.x, ey = b.y - a.y;
  const Point p{a.x + (0.5 * ex - height * ey), a.y + (0.5 * ey + height * ex)};
  if (!std::isfinite(p.x) || !std::isfinite(p.y)) return false;
  bool none = false;
  const Box way = Box::of(std::array{a, b, c, p});
  tree_.search([&](const Box& box) { return box.overlaps(way); },
               [&](std::int32_t i) {
                 const Segment& s = stuck_[i];
                 none = none || in_diametral_circle(p, s.a, s.b) || cross(a, p, s.a, s.b) || cross(b, p, s.a, s.b) ||
                        cross(c, p, s.a, s.b);
               });
  return none;
}

}  // namespace driftmesh
