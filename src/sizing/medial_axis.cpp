#include "sizing/medial_axis.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>
#include <optional>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "base/mix.hpp"
#include "geometry/box_tree.hpp"
#include "geometry/polygon.hpp"
#include "geometry/segment_geometry.hpp"
#include "geometry/triangle_geometry.hpp"
#include "sizing/nearest_in_square.hpp"

namespace driftmesh {
namespace {

using Ends = SegmentDistance::Ends;

constexpr double kSmall = 1.0 / 6;      // half diagonal of squares, relative to the distance
constexpr double kOpposite = -0.5;      // cosine of the least angle between directions to opposite sides
constexpr double kTolerance = 0x1p-10;  // by which another segment may be nearer, relative to the distance
constexpr double kOutside = 0.25;       // how far beyond a square its candidates are known, relative to its width
constexpr std::size_t kMostCandidates = 32;
constexpr std::size_t kSectors = 32;  // one candidate for each direction is kept, where there are more
constexpr int kDeepest = 48;

Point operator-(const Point& p, const Point& q) {
  return {p.x - q.x, p.y - q.y};
}
double dot(const Point& p, const Point& q) {
  return p.x * q.x + p.y * q.y;
}
double cross(const Point& p, const Point& q) {
  return p.x * q.y - p.y * q.x;
}
Point along(const Point& from, double way, const Point& direction) {
  return {from.x + way * direction.x, from.y + way * direction.y};
}

/// Angles that differ from one by at most a spread.
struct Directions {
  double angle = 0, spread = std::numbers::pi;
};

/// A segment, and the directions in which points of the domain can lie from it that it is nearest to.
struct Site {
  Point a, b;
  Directions inward{};
};

/// Of a point from a segment.
struct Offset {
  double distance;
  Point direction;  // unit, away from the segment; 0 on it
};

Point nearest_on(const Site& s, const Point& p) {
  return nearest_point_on_segment(p, s.a, s.b);
}

Offset offset_from(const Site& s, const Point& p) {
  const Point d = p - nearest_on(s, p);
  const double distance = std::sqrt(dot(d, d));
  return {distance, distance > 0 ? Point{d.x / distance, d.y / distance} : Point{}};
}

bool have_common_end(const Site& s, const Site& t) {
  return s.a == t.a || s.a == t.b || s.b == t.a || s.b == t.b;
}

/// By a full turn, into what is less than half of one, from at most one and a half.
double turned(double angle) {
  constexpr double kHalf = std::numbers::pi;
  return angle > kHalf ? angle - 2 * kHalf : angle < -kHalf ? angle + 2 * kHalf : angle;
}

struct HashOfPoint {
  std::size_t operator()(const Point& p) const {
    return mix(std::bit_cast<std::uint64_t>(p.x + 0.0) ^ mix(std::bit_cast<std::uint64_t>(p.y + 0.0)));
  }
};

/// Where directions reach from the normal of a segment to those of its neighbors, at corners that the domain surrounds.
std::vector<Site> sites_of(const OutlineSegments& outline) {
  struct Around {
    std::size_t in = 0, out = 0;
    int count_in = 0, count_out = 0;
  };
  std::unordered_map<Point, Around, HashOfPoint> points;
  std::vector<double> normals;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const auto& [a, b] = outline[i];
    normals.push_back(std::atan2(b.x - a.x, a.y - b.y));
    Around &from = points[a], &to = points[b];
    from.out = to.in = i;
    ++from.count_out;
    ++to.count_in;
  }
  std::vector<Site> sites;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    Site& site = sites.emplace_back(Site{outline[i].a, outline[i].b});
    const Around &first = points[site.a], &last = points[site.b];
    if (std::max({first.count_in, first.count_out, last.count_in, last.count_out}) > 1) continue;
    const double before = std::max(turned(normals[first.in] - normals[i]), 0.0);
    const double behind = std::min(turned(normals[last.out] - normals[i]), 0.0);
    site.inward.angle = turned(normals[i] + (before + behind) / 2);
    site.inward.spread = (before - behind) / 2;
  }
  return sites;
}

bool can_be_opposite(const Directions& s, const Directions& t) {
  constexpr double kLeast = 2 * std::numbers::pi / 3 - 1e-6;
  return std::fabs(turned(s.angle - t.angle)) + s.spread + t.spread >= kLeast;
}

class Finder {
 public:
  explicit Finder(const OutlineSegments& outline) : sites_(sites_of(outline)) {
    std::vector<Box> boxes;
    for (const auto& [a, b] : outline) boxes.push_back(Box::around(a, b));
    for (const Box& box : boxes) box_.extend(box);
    tree_ = BoxTree(boxes);
    margin_ = margin_in(box_);
  }

  std::vector<AxisPiece> find() {
    const Point center = box_.center();
    const double half = std::max(box_.high.x - box_.low.x, box_.high.y - box_.low.y) / 2;
    if (half > 0) search(Box::around(center, center, half), {}, 0);
    return std::move(pieces_);
  }

 private:
  using Candidates = std::vector<std::int32_t>;

  [[nodiscard]] std::int32_t nearest(const Point& p, const Candidates& among) const {
    const auto squared = [&](std::int32_t i) {
      const Site& s = sites_[i];
      return std::max(squared_distance_to_segment(p, s.a, s.b), Box::around(s.a, s.b).squared_distance(p));
    };
    if (among.empty()) return tree_.nearest(p, squared);
    return *std::ranges::min_element(among, {}, [&](std::int32_t i) { return std::pair(squared(i), i); });
  }

  /// `known`: holds all that can be nearest in the square and somewhat beyond it; none: any.
  void search(const Box& square, const Candidates& known, int depth) {
    const Point center = square.center();
    const double half = (square.high.x - square.low.x) / 2, radius = half * std::numbers::sqrt2;
    const std::int32_t first = nearest(center, known);
    const double distance = offset_from(sites_[first], center).distance;
    const bool is_small = radius <= kSmall * distance;
    const Candidates found = candidates(square, first, known, is_small ? sites_.size() : kMostCandidates);
    if (found.size() <= kMostCandidates || is_small) {
      if (is_outside(center, first, distance, radius)) return;
      const Candidates few = is_small && found.size() > kSectors ? nearest_in_sectors(center, found) : found;
      if (!may_hold_axis(center, radius, few)) return;
      if (is_small) return add_pieces(square, few, found);
    }
    if (depth == kDeepest) return;
    const Candidates& next = found.size() <= kMostCandidates ? found : known;
    for (const double dx : {-half / 2, half / 2})
      for (const double dy : {-half / 2, half / 2}) {
        const Point quarter{center.x + dx, center.y + dy};
        search(Box::around(quarter, quarter, half / 2), next, depth + 1);
      }
  }

  /// One more than `most` if there are more.
  [[nodiscard]] Candidates candidates(const Box& square, std::int32_t first, const Candidates& known,
                                      std::size_t most) const {
    const Box box = Box::around(square.low, square.high, kOutside * (square.high.x - square.low.x));
    const auto near = NearestInSquare::against(
        box, [&](const Point& p) { return offset_from(sites_[first], p).distance; }, margin_);
    Candidates found;
    const auto visit = [&](std::int32_t i) {
      const Site& s = sites_[i];
      if (found.size() <= most && near.needs(nearest_on(s, near.center()), s.a, s.b)) found.push_back(i);
    };
    if (known.empty())
      tree_.search([&](const Box& around) { return found.size() <= most && near.needs(0, around); }, visit);
    else
      std::ranges::for_each(known, visit);
    return found;
  }

  [[nodiscard]] bool is_outside(const Point& center, std::int32_t first, double distance, double radius) const {
    return distance > radius && !is_inside(center, sites_[first]);
  }

  /// `nearest`: to the point.
  [[nodiscard]] bool is_inside(const Point& p, const Site& nearest) const {
    const double t = nearest_on_segment(p, nearest.a, nearest.b);
    if (0 < t && t < 1) return cross(nearest.b - nearest.a, p - nearest.a) > 0;
    bool inside = false;
    const auto to_the_right = [&](const Box& box) {
      return box.low.y <= p.y && p.y <= box.high.y && box.high.x >= p.x;
    };
    tree_.search(to_the_right, [&](std::int32_t i) {
      const Site& s = sites_[i];
      if (spans_height(s.a, s.b, p.y) && (cross(s.b - s.a, p - s.a) > 0) == (s.b.y > s.a.y)) inside = !inside;
    });
    return inside;
  }

  /// In a disk. Also where segments with common ends surround a point.
  [[nodiscard]] bool may_hold_axis(const Point& center, double radius, const Candidates& found) const {
    std::vector<Directions> seen;  // from the segments to points of the disk
    for (const std::int32_t i : found) {
      const Offset o = offset_from(sites_[i], center);
      if (radius < o.distance)
        seen.push_back({std::atan2(o.direction.y, o.direction.x), std::asin(radius / o.distance)});
      else
        seen.push_back({});
    }
    for (std::size_t i = 0; i < found.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) {
        const Site &s = sites_[found[i]], &t = sites_[found[j]];
        if (can_be_opposite(s.inward, t.inward) && can_be_opposite(seen[i], seen[j]) &&
            (found.size() > 2 || !have_common_end(s, t)))
          return true;
      }
    return false;
  }

  // ---- Small squares ----

  /// `few`: with all pairs that count.
  void add_pieces(const Box& square, const Candidates& few, const Candidates& found) {
    constexpr double kNearlyOpposite = -0.1;  // at the center, where they are opposite somewhere in the square
    std::vector<Point> directions;
    for (const std::int32_t i : few) directions.push_back(offset_from(sites_[i], square.center()).direction);
    for (std::size_t i = 0; i < few.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) {
        if (dot(directions[i], directions[j]) > kNearlyOpposite) continue;
        if (!have_common_end(sites_[few[i]], sites_[few[j]]))
          add_between(square, few[i], few[j], few, found);
        else
          for (std::size_t k = 0; k < few.size(); ++k)
            if (k != i && k != j) add_summit(square, {few[i], few[j], few[k]}, few, found);
      }
  }

  [[nodiscard]] Candidates nearest_in_sectors(const Point& p, const Candidates& found) const {
    std::array<std::pair<double, std::int32_t>, kSectors> best;
    best.fill({std::numeric_limits<double>::infinity(), -1});
    for (const std::int32_t i : found) {
      const Offset o = offset_from(sites_[i], p);
      const double turn = 0.5 + std::atan2(o.direction.y, o.direction.x) / (2 * std::numbers::pi);
      auto& entry = best[std::min(static_cast<std::size_t>(turn * kSectors), kSectors - 1)];
      entry = std::min(entry, {o.distance, i});
    }
    Candidates few;
    for (const auto& [distance, i] : best)
      if (i >= 0) few.push_back(i);
    return few;
  }

  /// Moves a point to where it is as far from both, by Newton's method; false if it does not get there.
  static bool balance(const Site& s, const Site& t, Point& p) {
    for (int step = 0; step < 4; ++step) {
      const Offset to_s = offset_from(s, p), to_t = offset_from(t, p);
      const Point apart = to_s.direction - to_t.direction;
      const double square = dot(apart, apart);
      if (!(square > 1)) return false;
      p = along(p, (to_t.distance - to_s.distance) / square, apart);
    }
    return true;
  }

  void add_between(const Box& square, std::int32_t i, std::int32_t j, const Candidates& few, const Candidates& found) {
    const Site &s = sites_[i], &t = sites_[j];
    Point middle = square.center();
    if (!balance(s, t, middle)) return;
    const Point apart = offset_from(s, middle).direction - offset_from(t, middle).direction;
    const double length = std::sqrt(dot(apart, apart));
    const Point tangent{-apart.y / length, apart.x / length};
    double from = -std::numeric_limits<double>::infinity(), to = -from;  // along the tangent, in the square
    const auto clip = [&](double low, double high, double at, double by) {
      if (by == 0) {
        if (at < low || at > high) to = -std::numeric_limits<double>::infinity();
        return;
      }
      const auto [enters, leaves] = std::minmax({(low - at) / by, (high - at) / by});
      from = std::max(from, enters);
      to = std::min(to, leaves);
    };
    // A bit wider, so that rounding does not put an axis between two squares into neither.
    const double slack = kTolerance * offset_from(s, middle).distance;
    clip(square.low.x - slack, square.high.x + slack, middle.x, tangent.x);
    clip(square.low.y - slack, square.high.y + slack, middle.y, tangent.y);
    if (!(from <= to)) return;
    Point a = along(middle, from, tangent), b = along(middle, to, tangent);
    if (!balance(s, t, a) || !balance(s, t, b)) return;
    for (const std::int32_t k : few) {
      if (k == i || k == j) continue;
      const auto room = [&](const Point& p) {
        return offset_from(sites_[k], p).distance - (1 - kTolerance) * offset_from(s, p).distance;
      };
      if (!keep_positive(room, a, b)) return;
    }
    const auto excess = [&](const Point& p) {
      return kOpposite - dot(offset_from(s, p).direction, offset_from(t, p).direction);
    };
    if (keep_positive(excess, a, b)) add(a, b, found);
  }

  /// The part of ab where a function is positive, as if it were linear; false if there is none.
  template <class Function>
  static bool keep_positive(const Function& function, Point& a, Point& b) {
    const double at_a = function(a), at_b = function(b);
    if (at_a < 0 && at_b < 0) return false;
    if (at_a < 0) a = along(b, at_b / (at_b - at_a), a - b);
    if (at_b < 0) b = along(a, at_a / (at_a - at_b), b - a);
    return true;
  }

  /// The point as far from all three, if they surround it.
  void add_summit(const Box& square, const std::array<std::int32_t, 3>& three, const Candidates& few,
                  const Candidates& found) {
    Point p = square.center();
    std::array<Offset, 3> o{};
    for (int step = 0; step < 6; ++step) {
      for (std::size_t k = 0; k < 3; ++k) o[k] = offset_from(sites_[three[k]], p);
      const Point u = o[1].direction - o[0].direction, v = o[2].direction - o[0].direction;
      const double f = o[0].distance - o[1].distance, g = o[0].distance - o[2].distance, det = cross(u, v);
      if (!(std::fabs(det) > 1e-3)) return;
      p = {p.x + (f * v.y - g * u.y) / det, p.y + (u.x * g - v.x * f) / det};
    }
    const double slack = kTolerance * o[0].distance;
    if (!Box::around(square.low, square.high, slack).contains(p)) return;
    const double a = cross(o[0].direction, o[1].direction), b = cross(o[1].direction, o[2].direction),
                 c = cross(o[2].direction, o[0].direction);
    if (!((a > 0 && b > 0 && c > 0) || (a < 0 && b < 0 && c < 0))) return;
    for (const std::int32_t k : few)
      if (offset_from(sites_[k], p).distance < o[0].distance - slack) return;
    add(p, p, found);
  }

  void add(const Point& a, const Point& b, const Candidates& found) {
    const Point middle = midpoint(a, b), half{(b.x - a.x) / 2, (b.y - a.y) / 2};
    if (!is_inside(middle, sites_[nearest(middle, found)])) return;
    double radius = std::numeric_limits<double>::infinity();
    for (const std::int32_t k : found) {  // distances to segments are convex
      const Offset o = offset_from(sites_[k], middle);
      radius = std::min(radius, o.distance - std::fabs(dot(o.direction, half)));
    }
    pieces_.push_back({a, b, std::max(radius - margin_, 0.0)});
  }

  std::vector<Site> sites_;
  BoxTree tree_;
  Box box_;
  double margin_ = 0;  // for rounding
  std::vector<AxisPiece> pieces_;
};

}  // namespace

void sort_segments(OutlineSegments& outline) {
  std::ranges::sort(outline, {}, [](const Ends& s) { return std::tuple(s.a.x, s.a.y, s.b.x, s.b.y); });
}

std::vector<AxisPiece> medial_axis(const OutlineSegments& outline) {
  if (outline.empty()) return {};
  return Finder(outline).find();
}

}  // namespace driftmesh
