#include "oracles/mesh_faults.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "oracles/exact.hpp"
#include "oracles/words.hpp"

namespace driftmesh::oracles {
namespace {

constexpr double kLargest = 0x1p240;    // largest coordinate that predicates take
constexpr double kSmallest = 0x1p-190;  // besides 0; smaller ones that are in range do not occur
// Distances from a segment, in units of the last place of its largest coordinate: surely on it, and surely not.
constexpr long double kOn = 24, kOff = 48;
constexpr long double kSameArea = 1e-9L;  // relative

/// The sign of orient2d: by long doubles where their rounding cannot change it, or by rationals.
int turn(const Point& a, const Point& b, const Point& c) {
  const long double l = (static_cast<long double>(a.x) - c.x) * (static_cast<long double>(b.y) - c.y);
  const long double r = (static_cast<long double>(a.y) - c.y) * (static_cast<long double>(b.x) - c.x);
  const long double det = l - r;
  if (std::fabs(det) > 1e-17L * (std::fabs(l) + std::fabs(r))) return det > 0 ? 1 : -1;
  return side(ExactPoint(a), ExactPoint(b), ExactPoint(c));
}

int in_circle_of(const Point& a, const Point& b, const Point& c, const Point& d) {
  std::array<long double, 3> x{}, y{}, lift{};
  const std::array<const Point*, 3> corners{&a, &b, &c};
  for (std::size_t k = 0; k < 3; ++k) {
    x[k] = static_cast<long double>(corners[k]->x) - d.x;
    y[k] = static_cast<long double>(corners[k]->y) - d.y;
    lift[k] = x[k] * x[k] + y[k] * y[k];
  }
  long double det = 0, size = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
    det += lift[k] * (x[i] * y[j] - x[j] * y[i]);
    size += lift[k] * (std::fabs(x[i] * y[j]) + std::fabs(x[j] * y[i]));
  }
  if (std::fabs(det) > 1e-16L * size) return det > 0 ? 1 : -1;
  return in_circle(ExactPoint(a), ExactPoint(b), ExactPoint(c), ExactPoint(d));
}

bool in_box_of(const Point& a, const Point& b, const Point& p) {
  return std::min(a.x, b.x) <= p.x && p.x <= std::max(a.x, b.x) && std::min(a.y, b.y) <= p.y &&
         p.y <= std::max(a.y, b.y);
}

bool on_segment(const Point& a, const Point& b, const Point& p) {
  return in_box_of(a, b, p) && turn(a, b, p) == 0;
}

bool share_a_point(const Point& a, const Point& b, const Point& c, const Point& d) {
  if (on_segment(a, b, c) || on_segment(a, b, d) || on_segment(c, d, a) || on_segment(c, d, b)) return true;
  return turn(a, b, c) * turn(a, b, d) < 0 && turn(c, d, a) * turn(c, d, b) < 0;
}

using Edge = std::pair<std::int32_t, std::int32_t>;
Edge undirected(std::int32_t a, std::int32_t b) {
  return std::minmax(a, b);
}

class ByItself {
 public:
  explicit ByItself(const Mesh& mesh) : mesh_(mesh) {
    for (const Mesh::Edge& edge : mesh.edges) listed_.insert(undirected(edge.a, edge.b));
  }

  Fault find() {
    if (const std::string what = arrays(); !what.empty()) return {what, true, true};
    for (const auto check : {&ByItself::points, &ByItself::orientations, &ByItself::edges, &ByItself::overlaps,
                             &ByItself::boundary, &ByItself::delaunay})
      if (const std::string what = (this->*check)(); !what.empty()) return {what};
    return {};
  }

 private:
  [[nodiscard]] const Point& at(std::int32_t v) const { return mesh_.points[static_cast<std::size_t>(v)]; }

  [[nodiscard]] std::string arrays() const {
    const std::size_t points = mesh_.points.size(), triangles = mesh_.triangles.size();
    const auto is_wrong = [](const auto& array, std::size_t size) { return !array.empty() && array.size() != size; };
    if (is_wrong(mesh_.point_markers, points) || is_wrong(mesh_.regions, triangles) ||
        is_wrong(mesh_.subdomains, triangles) || is_wrong(mesh_.ranks, triangles) || mesh_.attributes_per_point < 0 ||
        mesh_.attributes.size() != points * static_cast<std::size_t>(mesh_.attributes_per_point))
      return "an array of the wrong length";
    const auto exists = [&](std::int32_t v) { return v >= 0 && static_cast<std::size_t>(v) < points; };
    for (const auto& [a, b, c] : mesh_.triangles)
      if (!exists(a) || !exists(b) || !exists(c) || a == b || b == c || c == a) return "a triangle of other points";
    for (const Mesh::Edge& edge : mesh_.edges)
      if (!exists(edge.a) || !exists(edge.b) || edge.a == edge.b) return "a subsegment of other points";
    return "";
  }

  std::string points() {
    std::set<std::int32_t> used;
    for (const auto& triangle : mesh_.triangles) used.insert(triangle.begin(), triangle.end());
    std::set<std::pair<double, double>> places;
    for (const std::int32_t v : used) {
      for (const double x : {at(v).x, at(v).y})
        if (!(std::fabs(x) <= kLargest) || (x != 0 && std::fabs(x) < kSmallest)) return words("coordinate ", x);
    }
    for (const std::int32_t v : used)
      if (!places.emplace(at(v).x, at(v).y).second) return words("point ", v, " lies on another one");
    return "";
  }

  std::string orientations() {
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      const auto& [a, b, c] = mesh_.triangles[t];
      if (turn(at(a), at(b), at(c)) <= 0) return words("triangle ", t, " is not counterclockwise");
    }
    return "";
  }

  std::string edges() {
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t)
      for (std::size_t k = 0; k < 3; ++k) {
        const std::int32_t a = mesh_.triangles[t][k], b = mesh_.triangles[t][(k + 1) % 3];
        if (!left_.emplace(Edge{a, b}, t).second) return words("two triangles left of ", a, "-", b);
      }
    if (listed_.size() != mesh_.edges.size()) return "a subsegment twice";
    for (const auto& [a, b] : listed_)
      if (!left_.contains({a, b}) && !left_.contains({b, a})) return words("subsegment ", a, "-", b, " is no edge");
    for (const auto& [edge, t] : left_) {
      if (left_.contains({edge.second, edge.first})) continue;
      boundary_.push_back(edge);
      if (!mesh_.edges.empty() && !listed_.contains(undirected(edge.first, edge.second)))
        return words("edge ", edge.first, "-", edge.second, " has one triangle and is not listed");
    }
    return "";
  }

  /// Triangles have no inner points in common if all of one lie beyond an edge of the other.
  std::string overlaps() {
    for (std::size_t s = 0; s < mesh_.triangles.size(); ++s)
      for (std::size_t t = 0; t < s; ++t)
        if (!apart_by_box(s, t) && !beyond(s, t) && !beyond(t, s))
          return words("triangles ", s, " and ", t, " overlap");
    return "";
  }
  [[nodiscard]] bool apart_by_box(std::size_t s, std::size_t t) const {
    const auto range = [&](std::size_t of, double Point::*coordinate) {
      const auto& [a, b, c] = mesh_.triangles[of];
      return std::minmax({at(a).*coordinate, at(b).*coordinate, at(c).*coordinate});
    };
    for (const auto coordinate : {&Point::x, &Point::y}) {
      const auto [low_s, high_s] = range(s, coordinate);
      const auto [low_t, high_t] = range(t, coordinate);
      if (high_s <= low_t || high_t <= low_s) return true;
    }
    return false;
  }
  [[nodiscard]] bool beyond(std::size_t s, std::size_t t) const {
    const auto &of = mesh_.triangles[s], &other = mesh_.triangles[t];
    for (std::size_t k = 0; k < 3; ++k)
      if (std::ranges::all_of(other, [&](std::int32_t v) { return turn(at(of[k]), at(of[(k + 1) % 3]), at(v)) <= 0; }))
        return true;
    return false;
  }

  std::string boundary() {
    for (std::size_t i = 0; i < boundary_.size(); ++i)
      for (std::size_t j = 0; j < i; ++j)
        if (meet_wrongly(boundary_[i], boundary_[j]))
          return words("boundary edges ", boundary_[i].first, "-", boundary_[i].second, " and ", boundary_[j].first,
                       "-", boundary_[j].second, " meet");
    return "";
  }
  [[nodiscard]] bool meet_wrongly(const Edge& e, const Edge& f) const {
    const bool first = e.first == f.first || e.first == f.second, last = e.second == f.first || e.second == f.second;
    if (first && last) return true;
    if (!first && !last) return share_a_point(at(e.first), at(e.second), at(f.first), at(f.second));
    const std::int32_t common = first ? e.first : e.second, of_e = first ? e.second : e.first;
    const std::int32_t of_f = f.first == common ? f.second : f.first;
    return on_segment(at(e.first), at(e.second), at(of_f)) || on_segment(at(f.first), at(f.second), at(of_e));
  }

  std::string delaunay() {
    for (const auto& [edge, t] : left_) {
      const auto other = left_.find({edge.second, edge.first});
      if (other == left_.end() || listed_.contains(undirected(edge.first, edge.second))) continue;
      if (!mesh_.subdomains.empty() && mesh_.subdomains[t] != mesh_.subdomains[other->second]) continue;
      const auto& [a, b, c] = mesh_.triangles[t];
      for (const std::int32_t v : mesh_.triangles[other->second])
        if (v != edge.first && v != edge.second && in_circle_of(at(a), at(b), at(c), at(v)) > 0)
          return words("edge ", edge.first, "-", edge.second, " is not Delaunay");
    }
    return "";
  }

  const Mesh& mesh_;
  std::set<Edge> listed_;
  std::map<Edge, std::size_t> left_;  // the triangle on the left of a directed edge
  std::vector<Edge> boundary_;
};

/// A mesh that has no fault by itself, beside one that is right.
class AgainstInput {
 public:
  AgainstInput(const Mesh& mesh, const Pslg& input, const Mesh& right) : mesh_(mesh), input_(input), right_(right) {
    for (const auto& triangle : mesh.triangles)
      for (const std::int32_t v : triangle) vertex_.emplace(place(mesh.points[static_cast<std::size_t>(v)]), v);
    subsegments_ = mesh.edges;
    if (subsegments_.empty()) subsegments_ = single_edges(mesh);
  }

  Fault find() {
    for (const auto check :
         {&AgainstInput::points, &AgainstInput::plane, &AgainstInput::regions, &AgainstInput::segments})
      if (std::string what = (this->*check)(); !what.empty()) return {std::move(what), certain_};
    return {"", certain_};
  }

 private:
  using Place = std::pair<double, double>;
  static Place place(const Point& p) { return {p.x, p.y}; }
  static const Point& at(const Mesh& mesh, std::int32_t v) { return mesh.points[static_cast<std::size_t>(v)]; }

  static std::vector<Mesh::Edge> single_edges(const Mesh& mesh) {
    std::set<Edge> sides;
    for (const auto& [a, b, c] : mesh.triangles) sides.insert({{a, b}, {b, c}, {c, a}});
    std::vector<Mesh::Edge> single;
    for (const auto& [a, b] : sides)
      if (!sides.contains({b, a})) single.push_back({a, b, 0});
    return single;
  }

  std::string points() {
    std::set<Place> expected;
    for (const auto& triangle : right_.triangles)
      for (const std::int32_t v : triangle) expected.insert(place(at(right_, v)));
    for (std::size_t i = 0; i < input_.points.size(); ++i) {
      if (!expected.contains(place(input_.points[i]))) continue;
      const auto vertex = vertex_.find(place(input_.points[i]));
      if (vertex == vertex_.end()) return words("input point ", i, " is no vertex");
      if (!has_marker(vertex->second, i)) return words("input point ", i, " has another marker");
      if (!has_attributes(static_cast<std::size_t>(vertex->second), i))
        return words("input point ", i, " has other attributes");
    }
    return "";
  }
  [[nodiscard]] bool has_marker(std::int32_t v, std::size_t i) const {
    if (mesh_.point_markers.empty() || input_.point_markers.empty()) return true;
    const std::int32_t actual = mesh_.point_markers[static_cast<std::size_t>(v)], expected = input_.point_markers[i];
    return actual == expected || (expected == 0 && std::ranges::any_of(mesh_.edges, [&](const Mesh::Edge& edge) {
                                    return (edge.a == v || edge.b == v) && (actual == 1 || actual == edge.marker);
                                  }));
  }
  [[nodiscard]] bool has_attributes(std::size_t v, std::size_t i) const {
    const auto width = static_cast<std::size_t>(mesh_.attributes_per_point);
    if (width == 0 || input_.attributes_per_point == 0) return true;
    if (mesh_.attributes_per_point != input_.attributes_per_point) return false;
    for (std::size_t k = 0; k < width; ++k)
      if (mesh_.attributes[v * width + k] != input_.attributes[i * width + k]) return false;
    return true;
  }

  [[nodiscard]] static long double area(const Mesh& mesh) {
    long double sum = 0;
    for (const auto& [a, b, c] : mesh.triangles) {
      const Point &o = at(mesh, a), &p = at(mesh, b), &q = at(mesh, c);
      sum += (static_cast<long double>(p.x) - o.x) * (static_cast<long double>(q.y) - o.y) -
             (static_cast<long double>(p.y) - o.y) * (static_cast<long double>(q.x) - o.x);
    }
    return sum / 2;
  }

  std::string plane() {
    const long double actual = area(mesh_), expected = area(right_);
    if (std::fabs(actual - expected) > kSameArea * expected)
      return words("the area is ", static_cast<double>(actual), ", not ", static_cast<double>(expected));
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t)
      if (triangles_at(centroid(t)).empty()) return words("triangle ", t, " is outside the domain");
    return "";
  }

  std::string regions() {
    if (mesh_.regions.empty() || input_.regions.empty()) return "";
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t)
      if (std::ranges::none_of(triangles_at(centroid(t)),
                               [&](std::size_t r) { return right_.regions[r] == mesh_.regions[t]; }))
        return words("triangle ", t, " has another region");
    return "";
  }

  [[nodiscard]] Point centroid(std::size_t t) const {
    const auto& [a, b, c] = mesh_.triangles[t];
    const Point &p = at(mesh_, a), &q = at(mesh_, b), &r = at(mesh_, c);
    return {p.x / 3 + q.x / 3 + r.x / 3, p.y / 3 + q.y / 3 + r.y / 3};
  }
  /// Triangles of the right mesh; several if the point is on an edge.
  [[nodiscard]] std::vector<std::size_t> triangles_at(const Point& p) const {
    std::vector<std::size_t> found;
    for (std::size_t t = 0; t < right_.triangles.size(); ++t) {
      const auto& [i, j, k] = right_.triangles[t];
      const Point &a = at(right_, i), &b = at(right_, j), &c = at(right_, k);
      const auto [low, high] = std::minmax({a.x, b.x, c.x});
      if (p.x < low || p.x > high) continue;
      if (turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0) found.push_back(t);
    }
    return found;
  }

  // ---- Segments ----

  struct Part {
    long double from, to;
    std::int32_t first, last;
  };

  std::string segments() {
    std::vector<int> uses(subsegments_.size());
    for (const Pslg::Segment& s : input_.segments)
      if (std::string what = segment(s, uses); !what.empty()) return what;
    if (input_.segments.empty()) return hull(uses);
    for (std::size_t e = 0; e < uses.size(); ++e)
      if (uses[e] != 1) return words("subsegment ", e, " lies on ", uses[e], " input segments");
    return "";
  }

  /// Without segments, the boundary has marker 1, and there are no other subsegments.
  std::string hull(const std::vector<int>& /*uses*/) {
    std::set<Edge> single;
    for (const Mesh::Edge& edge : single_edges(mesh_)) single.insert(undirected(edge.a, edge.b));
    for (const Mesh::Edge& edge : subsegments_)
      if (edge.marker != 1 || !single.contains(undirected(edge.a, edge.b))) return "another subsegment";
    return "";
  }

  std::string segment(const Pslg::Segment& s, std::vector<int>& uses) {
    const Point &a = input_.points[static_cast<std::size_t>(s.a)], &b = input_.points[static_cast<std::size_t>(s.b)];
    if (!is_in_domain(a, b)) return "";
    std::vector<Part> parts;
    for (std::size_t e = 0; e < subsegments_.size(); ++e) {
      const std::optional<Part> part = part_on(subsegments_[e], a, b);
      if (!part) continue;
      parts.push_back(*part);
      ++uses[e];
      if (subsegments_[e].marker != s.marker) return words("subsegment ", e, " has another marker");
    }
    std::ranges::sort(parts, {}, &Part::from);
    if (parts.empty() || !(at(mesh_, parts.front().first) == a) || !(at(mesh_, parts.back().last) == b))
      return words("the segment from (", a.x, ", ", a.y, ") is not covered");
    for (std::size_t i = 1; i < parts.size(); ++i)
      if (parts[i].first != parts[i - 1].last) return words("a gap on the segment from (", a.x, ", ", a.y, ")");
    return "";
  }

  [[nodiscard]] bool is_in_domain(const Point& a, const Point& b) {
    const bool before = certain_;
    const bool found = std::ranges::any_of(
        right_.edges, [&](const Mesh::Edge& edge) { return part_of(right_, edge, a, b).has_value(); });
    certain_ = before;
    return found;
  }
  [[nodiscard]] std::optional<Part> part_on(const Mesh::Edge& edge, const Point& a, const Point& b) {
    return part_of(mesh_, edge, a, b);
  }

  std::optional<Part> part_of(const Mesh& mesh, const Mesh::Edge& edge, const Point& a, const Point& b) {
    const long double dx = static_cast<long double>(b.x) - a.x, dy = static_cast<long double>(b.y) - a.y;
    const long double length = std::sqrt(dx * dx + dy * dy);
    const long double unit = 0x1p-52L * std::max({std::fabs(a.x), std::fabs(a.y), std::fabs(b.x), std::fabs(b.y)});
    Part part{0, 0, edge.a, edge.b};
    long double worst = 0;
    const auto along = [&](std::int32_t v) {
      const long double px = static_cast<long double>(at(mesh, v).x) - a.x,
                        py = static_cast<long double>(at(mesh, v).y) - a.y;
      const long double t = (px * dx + py * dy) / length;
      worst = std::max({worst, std::fabs(px * dy - py * dx) / length, -t, t - length});
      return t;
    };
    part.from = along(edge.a);
    part.to = along(edge.b);
    if (worst > kOff * unit) return std::nullopt;
    if (worst > kOn * unit) certain_ = false;
    if (part.from > part.to) {
      std::swap(part.from, part.to);
      std::swap(part.first, part.last);
    }
    return part;
  }

  const Mesh& mesh_;
  const Pslg& input_;
  const Mesh& right_;
  std::map<Place, std::int32_t> vertex_;
  std::vector<Mesh::Edge> subsegments_;
  bool certain_ = true;
};

}  // namespace

Fault fault_of(const Mesh& mesh) {
  return ByItself(mesh).find();
}

Fault fault_of(const Mesh& mesh, const Pslg& input, const Mesh& right) {
  Fault fault = fault_of(mesh);
  return fault.what.empty() ? AgainstInput(mesh, input, right).find() : fault;
}

}  // namespace driftmesh::oracles
