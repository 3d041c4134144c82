#include "oracles/random_pslg.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geometry/midpoint.hpp"
#include "geometry/predicates.hpp"
#include "oracles/mesh_oracle.hpp"

namespace driftmesh::oracles {
namespace {

double distance_to(const Point& p, const Point& a, const Point& b) {
  const double dx = b.x - a.x, dy = b.y - a.y;
  const double t = std::clamp(((p.x - a.x) * dx + (p.y - a.y) * dy) / (dx * dx + dy * dy), 0.0, 1.0);
  return std::hypot(a.x + t * dx - p.x, a.y + t * dy - p.y);
}

bool between(const Point& p, const Point& a, const Point& b) {
  return std::min(a.x, b.x) <= p.x && p.x <= std::max(a.x, b.x) && std::min(a.y, b.y) <= p.y &&
         p.y <= std::max(a.y, b.y);
}

class Builder {
 public:
  Builder(std::uint64_t seed, const RandomPslgShape& shape) : random_(seed), shape_(shape) {}

  RandomPslg build() {
    add_ring({0, 0}, 1, std::max(3, shape_.outer_points), true);
    for (int i = 0; i < shape_.holes; ++i)
      if (Point center; add_inner_ring(center, true)) result_.input.holes.push_back(place(center));
    for (int i = 0; i < shape_.rings; ++i)
      if (Point center; add_inner_ring(center, false))
        result_.input.regions.push_back({place(center), static_cast<double>(i + 1), 0});
    for (int i = 0; i < shape_.inner_points; ++i)
      if (const Point p = uniform_point(); fits(place(p)) && inside(place(p))) take_point(place(p));
    for (int i = 0; i < shape_.dangling_segments; ++i) add_dangling();
    for (int i = 0; i < 4 * shape_.inner_segments && inner_ < shape_.inner_segments; ++i) add_inner();
    return std::move(result_);
  }

 private:
  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  std::int32_t any_point() {
    return std::uniform_int_distribution<std::int32_t>(0, static_cast<std::int32_t>(points().size()) - 1)(random_);
  }
  Point uniform_point() { return {uniform(-1, 1), uniform(-1, 1)}; }
  [[nodiscard]] Point place(const Point& p) const {
    return {shape_.offset + shape_.scale * p.x, shape_.offset + shape_.scale * p.y};
  }
  std::vector<Point>& points() { return result_.input.points; }
  [[nodiscard]] const Point& at(std::int32_t i) const { return result_.input.points[i]; }

  std::int32_t take_point(const Point& p) {
    points().push_back(p);
    return static_cast<std::int32_t>(points().size()) - 1;
  }

  /// A star-shaped polygon around the center, one vertex in each of n equal sectors; neighbors are less than half a
  /// turn apart, so that the center is inside.
  void add_ring(const Point& center, double radius, int n, bool boundary) {
    const auto first = static_cast<std::int32_t>(points().size());
    for (int i = 0; i < n; ++i) {
      const double angle = (i + (n == 3 ? uniform(0.3, 0.7) : uniform(0.05, 0.95))) * 2 * std::numbers::pi / n;
      const double r = radius * (1 - shape_.spikiness * uniform(0, 1) * (i % 2 == 0 ? 0.2 : 1));
      take_point(place({center.x + r * std::cos(angle), center.y + r * std::sin(angle)}));
    }
    for (int i = 0; i < n; ++i) {
      if (boundary) result_.boundary_segments.push_back(result_.input.segments.size());
      result_.input.segments.push_back({first + i, first + (i + 1) % n, i + 1});
    }
  }

  bool add_inner_ring(Point& center, bool hole) {
    for (int attempt = 0; attempt < 50; ++attempt) {
      center = uniform_point();
      if (!inside(place(center))) continue;
      double room = 1;
      for (const auto& s : result_.input.segments)
        room = std::min(room, distance_to(place(center), at(s.a), at(s.b)) / shape_.scale);
      if (room < 0.05) continue;
      const bool in_ring = std::any_of(rings_.begin(), rings_.end(), [&](const Ring& ring) {
        return std::hypot(ring.center.x - center.x, ring.center.y - center.y) < ring.radius + 0.05;
      });
      if (in_ring) continue;
      add_ring(center, room * uniform(0.5, 0.95), static_cast<int>(uniform(3, 9)), hole);
      rings_.push_back({center, room});
      return true;
    }
    return false;
  }

  bool inside(const Point& p) { return inside_by_parity(result_.input, result_.boundary_segments, p); }

  /// Whether p can be added without touching anything.
  bool fits(const Point& p) {
    for (const Point& q : points())
      if (p == q) return false;
    for (const auto& s : result_.input.segments)
      if (orient2d(at(s.a), at(s.b), p) == 0 && between(p, at(s.a), at(s.b))) return false;
    return true;
  }

  /// Whether the segment from a to b can be added to the domain without touching anything but a and b.
  bool connects(const Point& a, const Point& b) {
    for (const Point& p : points())
      if (!(p == a) && !(p == b) && orient2d(a, b, p) == 0 && between(p, a, b)) return false;
    for (const auto& s : result_.input.segments) {
      const Point &c = at(s.a), &d = at(s.b);
      if ((c == a && d == b) || (c == b && d == a)) return false;
      if (c == a || c == b || d == a || d == b) continue;
      const double a1 = orient2d(c, d, a), a2 = orient2d(c, d, b), b1 = orient2d(a, b, c), b2 = orient2d(a, b, d);
      if (((a1 > 0) != (a2 > 0) || a1 == 0 || a2 == 0) && ((b1 > 0) != (b2 > 0) || b1 == 0 || b2 == 0)) return false;
    }
    return inside(midpoint(a, b));
  }

  void add_inner() {
    const std::int32_t a = any_point(), b = any_point();
    if (a == b || !connects(at(a), at(b))) return;
    result_.input.segments.push_back({a, b, 100 + inner_++});
  }

  void add_dangling() {
    const std::int32_t a = any_point();
    const Point p = place(uniform_point());
    if (!fits(p) || !inside(p) || !connects(at(a), p)) return;
    result_.input.segments.push_back({a, take_point(p), 50});
  }

  struct Ring {
    Point center;
    double radius;
  };

  std::mt19937_64 random_;
  RandomPslgShape shape_;
  RandomPslg result_;
  std::vector<Ring> rings_;
  int inner_ = 0;
};

}  // namespace

RandomPslg make_random_pslg(std::uint64_t seed, const RandomPslgShape& shape) {
  return Builder(seed, shape).build();
}

RandomPslgShape make_random_shape(std::uint64_t seed) {
  std::mt19937_64 random(seed * 0x9e3779b97f4a7c15u + 1);
  const auto pick = [&](int low, int high) { return std::uniform_int_distribution<int>(low, high)(random); };
  RandomPslgShape shape;
  shape.outer_points = pick(3, 16);
  shape.holes = pick(0, 3);
  shape.rings = pick(0, 2);
  shape.inner_segments = pick(0, 8);
  shape.dangling_segments = pick(0, 3);
  shape.inner_points = pick(0, 10);
  shape.spikiness = pick(0, 9) / 10.0;
  shape.scale = std::ldexp(1.0, pick(-20, 20));
  shape.offset = pick(0, 3) == 0 ? 1000 * shape.scale : 0;
  return shape;
}

}  // namespace driftmesh::oracles
