#include "mesh/forecast.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "geometry/midpoint.hpp"
#include "geometry/triangle_geometry.hpp"
#include "mesh/channel.hpp"

namespace driftmesh {
namespace {

// Fitted together with the table of growth.cpp.

/// A triangle whose edges at a vertex are longer than the size there sees that size, but at most this much smaller than
/// its own edges: around a vertex edges may grow, too.
constexpr double kTurn = 2.2;
/// Triangles in a channel, per width squared of its area; and along its outside, relative to growth away from a line.
constexpr double kInChannel = 1.08;
constexpr double kBesideChannel = 0.63;
/// Only bases that are longer than this times the height of their triangle can be in a channel worth mentioning.
constexpr double kLongBase = 1.5;
/// Triangles in a wedge per edge along it.
constexpr double kInWedge = 1.9;
/// Edges that bounds on area and size ask for, per square root of the area of a triangle that they ask for: those of an
/// equilateral one.
constexpr double kAskedEdge = 1.52;
/// Below this angle bound, in degrees, channels and wedges have fewer: their triangles may be longer.
constexpr double kFlat = 20;
/// Mean distance of a compact triangle's points from a corner, relative to that of the centroid.
constexpr double kMeanDistance = 0.93;

/// Triangles in a channel, and on the outside of its wall.
struct Alongside {
  double inside = 0, beside = 0;
};

/// Those of the channel over the base of a triangle with this height, whose foot divides the base at `foot`.
Alongside alongside(const Channel& c, double base, double height, double foot, const Growth& growth) {
  const double middle = std::clamp(foot, c.from, c.to);
  const auto height_at = [&](double x) {
    return x <= foot ? height * (foot > 0 ? x / foot : 1) : height * (base - x) / (base - foot);
  };
  const auto strip = [&](double from, double to) {
    if (!(from < to)) return 0.0;
    return integrate_strip(to - from, height_at(from), height_at(to), c.width_at(from), c.width_at(to));
  };
  const double edges = integrate_line(c.to - c.from, c.width_at(c.from), c.width_at(c.to));
  return {kInChannel * (strip(c.from, middle) + strip(middle, c.to)),
          kBesideChannel * growth.density / growth.slope * edges};
}

/// Whether there is much more room on the other side of a segment than in a channel along it.
bool is_open_beyond(const Triangulation& mesh, HalfEdge base, double length, double width) {
  const HalfEdge beyond = mesh.across(base);
  if (beyond == kNone) return false;
  constexpr double kMuch = 2;
  const Facing facing = facing_segments(mesh, beyond, length);
  for (int i = 0; i < facing.count; ++i)
    if (facing.channels[i].least_width() < kMuch * width) return false;
  return !facing.same_shell;
}

}  // namespace

/// Lengths and angles of a triangle; edge i is opposite to corner i.
struct Forecast::Shape {
  TriangleId t;
  double twice_area = 0;
  double asked = 0;               // triangles, by the bounds on area and size
  std::array<double, 3> squared;  // lengths of the edges
  std::array<double, 3> length;
  std::array<double, 3> size;  // at the corners
  bool good = false;           // meets the angle bound, and no corner has less than the triangle's own edges

  [[nodiscard]] double area() const { return twice_area / 2; }
};

Forecast::Forecast(const Triangulation& mesh, const QualityBounds& bounds)
    : mesh_(mesh),
      bound_(mesh, bounds),
      growth_(growth_of(bounds.min_angle)),
      flatness_(std::min(1.0, bounds.min_angle / kFlat)) {
  const double sine = std::sin(bounds.min_angle * (std::numbers::pi / 180));
  sin_squared_ = sine * sine;
  if (bounds.min_angle > 0) sizes_ = feature_sizes(mesh);
}

Forecast::Shape Forecast::shape_of(TriangleId t, double twice_area, double asked) const {
  const Point &a = mesh_.corner(t, 0), &b = mesh_.corner(t, 1), &c = mesh_.corner(t, 2);
  Shape s;
  s.t = t;
  s.twice_area = twice_area;
  s.asked = asked;
  s.squared = {squared_distance(b, c), squared_distance(c, a), squared_distance(a, b)};
  for (int i = 0; i < 3; ++i) s.length[i] = std::sqrt(s.squared[i]);
  if (!sizes_.empty()) set_sizes(s);
  return s;
}

/// The size at a corner: that of the triangle's own edges and segments there, or that of the vertex if it is much less.
void Forecast::set_sizes(Shape& s) const {
  const auto& v = mesh_.triangles[s.t].vertex;
  std::array<double, 3> own{kNoBound, kNoBound, kNoBound};
  for (int i = 0; i < 3; ++i) {
    const VertexId a = v[next(i)], b = v[previous(i)];
    own[i] = std::min(own[i], kPartOfHeight * distance_to_segment(mesh_, s.t, i, s.length[i], s.twice_area));
    if (!is_constrained(mesh_.twin(half_edge(s.t, i))) && is_shell_edge(mesh_, a, b)) continue;
    own[next(i)] = std::min(own[next(i)], s.length[i]);
    own[previous(i)] = std::min(own[previous(i)], s.length[i]);
  }
  s.good = meets_angle_bound(s.twice_area, s.squared[0], s.squared[1], s.squared[2]);
  for (int i = 0; i < 3; ++i) {
    const double size = sizes_[v[i]];
    s.size[i] = std::clamp(own[i], size, kTurn * size);
    s.good = s.good && s.size[i] >= own[i];
  }
}

bool Forecast::meets_angle_bound(double twice_area, double bc, double ca, double ab) const {
  return twice_area * twice_area >= sin_squared_ * std::max(bc * ca, std::max(ca * ab, ab * bc));
}

/// Edges along segment i of a triangle in a wedge, as sizes grow from both of its ends, and as the bounds ask for
/// beside the wedge: all segments of a corner are split alike.
double Forecast::along_wedge(const Shape& s, int i) const {
  const auto& v = mesh_.triangles[s.t].vertex;
  const double a = kTurn * sizes_[v[next(i)]], b = kTurn * sizes_[v[previous(i)]], length = s.length[i];
  const double middle = std::clamp((b - a) / growth_.slope + length, 0.0, 2 * length) / 2;
  const double grown = integrate_line(middle, a, a + growth_.slope * middle) +
                       integrate_line(length - middle, b, b + growth_.slope * (length - middle));
  return std::max(grown, length / kAskedEdge * std::sqrt(s.asked / s.area()));
}

/// The sum over the corners of what grows away from them, or, farther away, of what the bounds ask for.
double Forecast::grown(const Shape& s) const {
  const double longest = std::max(s.length[0], std::max(s.length[1], s.length[2]));
  constexpr double kCompact = 4;  // sizes vary little
  if (longest <= kCompact * std::min(s.size[0], std::min(s.size[1], s.size[2]))) {
    const Point middle = centroid({mesh_.corner(s.t, 0), mesh_.corner(s.t, 1), mesh_.corner(s.t, 2)});
    return std::max(s.asked, s.area() * growth_density(s, middle, kMeanDistance));
  }
  const double bound_size = s.asked > 0 ? std::sqrt(growth_.density * s.area() / s.asked) : kNoBound;
  Covered sum;
  for (int i = 0; i < 3; ++i) {
    const auto [near, far] = std::minmax(s.length[next(i)], s.length[previous(i)]);
    const double angle = std::atan2(2 * s.twice_area, s.squared[next(i)] + s.squared[previous(i)] - s.squared[i]);
    sum += grown_from({angle, near, far, s.length[i], s.area()}, s.size[i], (bound_size - s.size[i]) / growth_.slope,
                      growth_);
  }
  return sum.triangles + (sum.area < s.area() ? s.asked * (1 - sum.area / s.area()) : 0);
}

double Forecast::growth_density(const Shape& s, const Point& p, double stretch) const {
  double sum = 0;
  for (int i = 0; i < 3; ++i) {
    const double h = s.size[i] + growth_.slope * stretch * std::sqrt(squared_distance(p, mesh_.corner(s.t, i)));
    sum += 1 / (h * h);
  }
  return growth_.density * sum;
}

/// The triangles that cover this one because of the angle bound, or the other bounds where these ask for more.
double Forecast::detailed(const Shape& s) const {
  if (s.good) return s.asked;
  double most = grown(s), beside = 0;
  for (int i = 0; i < 3; ++i) {
    const HalfEdge base = half_edge(s.t, i);
    if (!is_constrained(mesh_.twin(base))) continue;
    const double height = s.twice_area / s.length[i];
    const Subsegment& segment = mesh_.subsegments[subsegment_of(mesh_.twin(base))];
    if (s.length[i] < kLongBase * height && mesh_.roots[segment.root].shell == kNone) continue;
    const Facing facing = facing_segments(mesh_, base, s.length[i]);
    if (facing.same_shell) return std::max(s.asked, flatness_ * kInWedge * along_wedge(s, i));
    const double foot = (s.squared[i] + s.squared[previous(i)] - s.squared[next(i)]) / (2 * s.length[i]);
    double inside = 0;
    for (int k = 0; k < facing.count; ++k) {
      const Channel& channel = facing.channels[k];
      const Alongside along = alongside(channel, s.length[i], height, std::clamp(foot, 0.0, s.length[i]), growth_);
      inside += flatness_ * along.inside;
      if (is_open_beyond(mesh_, base, s.length[i], channel.least_width())) beside += flatness_ * along.beside;
    }
    most = std::max(most, inside);
  }
  return std::max(s.asked, most + beside);
}

double Forecast::least_size(TriangleId t) const {
  const auto& v = mesh_.triangles[t].vertex;
  return std::min(sizes_[v[0]], std::min(sizes_[v[1]], sizes_[v[2]]));
}

/// Whether it is plain, without roots and logarithms, that details of the input add no triangles to this one: the
/// bounds ask for smaller ones than the details do, or it meets the angle bound and has no smaller details around it.
bool Forecast::is_plain(TriangleId t, double twice_area, double asked) const {
  if (sizes_.empty()) return true;
  const double least = least_size(t);
  if (asked * (least * least) >= growth_.density * twice_area / 2) return true;
  const Point &a = mesh_.corner(t, 0), &b = mesh_.corner(t, 1), &c = mesh_.corner(t, 2);
  const double bc = squared_distance(b, c), ca = squared_distance(c, a), ab = squared_distance(a, b);
  if (!meets_angle_bound(twice_area, bc, ca, ab)) return false;
  const auto has_no_smaller = [&](int i, double nearer) {
    const double size = kTurn * sizes_[mesh_.triangles[t].vertex[i]];
    return size * size >= nearer;
  };
  return has_no_smaller(0, std::min(ca, ab)) && has_no_smaller(1, std::min(ab, bc)) &&
         has_no_smaller(2, std::min(bc, ca));
}

double Forecast::in(TriangleId t) const {
  const double twice_area = 2 * signed_area(mesh_.corner(t, 0), mesh_.corner(t, 1), mesh_.corner(t, 2));
  const double asked = bound_.in(t, twice_area);
  return std::max(1.0, is_plain(t, twice_area, asked) ? asked : detailed(shape_of(t, twice_area, asked)));
}

double Forecast::total() const {
  // One in kStride stands for triangles that cannot become many, if there are very many of them.
  constexpr std::size_t kMany = 30'000;
  constexpr int kStride = 8;
  constexpr double kFew = 300;
  const bool all = mesh_.live_triangles() <= kMany;
  double sum = 0;
  int passed = 0;
  for (const TriangleId t : ids_of(mesh_.triangles)) {
    if (!mesh_.triangles[t].alive()) continue;
    const double twice_area = 2 * signed_area(mesh_.corner(t, 0), mesh_.corner(t, 1), mesh_.corner(t, 2));
    const double asked = bound_.in(t, twice_area);
    if (is_plain(t, twice_area, asked)) {
      sum += std::max(1.0, asked);
      continue;
    }
    const double least = least_size(t);
    const bool few = asked <= kFew && 1.5 * growth_.density * twice_area <= kFew * least * least;
    if (!all && few && passed++ % kStride != 0) continue;
    sum += (!all && few ? kStride : 1) * std::max(1.0, detailed(shape_of(t, twice_area, asked)));
  }
  return sum;
}

/// Triangles per area, roughly.
double Forecast::density(const Shape& s, const Point& p) const {
  const double asked = s.asked / s.area();
  return sizes_.empty() ? asked : std::max(asked, growth_density(s, p, 1));
}

void Forecast::spread(const Shape& s, const CornerPoints& part, double count, double quota, int halvings,
                      const std::function<void(const Point& at, double triangles)>& visit) const {
  if (count <= quota || halvings == 0) return visit(centroid(part), count);
  int longest = 0;
  for (const int i : {1, 2})
    if (squared_distance(part[next(i)], part[previous(i)]) >
        squared_distance(part[next(longest)], part[previous(longest)]))
      longest = i;
  const Point &apex = part[longest], &a = part[next(longest)], &b = part[previous(longest)];
  const Point m = midpoint(a, b);
  const CornerPoints first{apex, a, m}, second{apex, m, b};
  const double here = density(s, centroid(first)), there = density(s, centroid(second));
  const double ratio = there / here;
  const double share = ratio > 0 ? 1 / (1 + ratio) : 0.5;
  spread(s, first, count * share, quota, halvings - 1, visit);
  spread(s, second, count * (1 - share), quota, halvings - 1, visit);
}

void Forecast::visit_samples(double quota, const std::function<void(const Point& at, double triangles)>& visit) const {
  constexpr int kHalvings = 40;
  double pending = 0;
  Point last{};
  for (const TriangleId t : ids_of(mesh_.triangles)) {
    if (!mesh_.triangles[t].alive()) continue;
    const CornerPoints corners{mesh_.corner(t, 0), mesh_.corner(t, 1), mesh_.corner(t, 2)};
    const double count = in(t);
    if (count > quota) {
      const double twice_area = 2 * signed_area(corners[0], corners[1], corners[2]);
      spread(shape_of(t, twice_area, bound_.in(t, twice_area)), corners, count, quota, kHalvings, visit);
      continue;
    }
    pending += count;
    last = centroid(corners);
    if (pending < quota) continue;
    visit(last, pending);
    pending = 0;
  }
  if (pending > 0) visit(last, pending);
}

double forecast_triangles(const Triangulation& mesh, const QualityBounds& bounds) {
  return Forecast(mesh, bounds).total();
}

}  // namespace driftmesh
