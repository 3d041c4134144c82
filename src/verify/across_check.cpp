#include "verify/across_check.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "base/disjoint_sets.hpp"
#include "base/formatted.hpp"
#include "geometry/box_tree.hpp"
#include "geometry/midpoint.hpp"
#include "geometry/predicates.hpp"
#include "geometry/segment_geometry.hpp"
#include "geometry/triangle_geometry.hpp"
#include "verify/corner_table.hpp"
#include "verify/words.hpp"

namespace driftmesh {
namespace {

constexpr double kOpposite = -0.57357643635104609;  // cosine of 125 degrees
constexpr double kTurn = std::numbers::pi / 12;     // between directions at a corner

Point operator-(const Point& p, const Point& q) {
  return {p.x - q.x, p.y - q.y};
}
double dot(const Point& p, const Point& q) {
  return p.x * q.x + p.y * q.y;
}
double cross(const Point& p, const Point& q) {
  return p.x * q.y - p.y * q.x;
}

/// A place on the boundary: on an edge, or at a vertex where two segments meet.
struct Foot {
  Point at;
  std::int32_t edge;            // one of the edges that it is on
  std::int32_t vertex = kNone;  // where it is at one
};

class Channels {
 public:
  Channels(const Mesh& mesh, const std::function<bool(std::int32_t)>& is_corner, const AcrossRule& rule,
           Findings& findings)
      : mesh_(mesh), corners_(mesh), rule_(rule), findings_(findings) {
    find_edges();
    join_segments(is_corner);
    std::vector<Box> boxes;
    for (const Edge& edge : edges_) boxes.push_back(Box::around(at(edge.from), at(edge.to)));
    for (const Box& box : boxes) box_.extend(box);
    tree_ = BoxTree(boxes);
  }

  AcrossReport check() {
    report_.fewest = rule_.layers;
    for (const std::int32_t e : first_ids<std::int32_t>(edges_.size())) {
      look_from({midpoint(at(edges_[e].from), at(edges_[e].to)), e}, inward(e));
      look_around(e);
    }
    for (const auto& [a, b, c] : mesh_.triangles)
      if (before_[a] != kNone && before_[b] != kNone && before_[c] != kNone) ++report_.on_boundary;
    return report_;
  }

 private:
  /// The domain lies to the left.
  struct Edge {
    std::int32_t from, to;  // vertices
    std::int32_t triangle;
    std::int32_t segment = kNone;
  };
  struct Ends {
    std::int32_t first = kNone, last = kNone;  // vertices; none of a ring without corners
  };

  [[nodiscard]] const Point& at(std::int32_t vertex) const { return mesh_.points[vertex]; }

  /// The other triangle at an edge of a triangle, in which it leads from u to v; kNone: there is none.
  [[nodiscard]] std::int32_t across(std::int32_t u, std::int32_t v) const {
    for (const std::uint32_t corner : corners_.around(u))
      if (mesh_.triangles[corner / 3][(corner % 3 + 2) % 3] == v) return static_cast<std::int32_t>(corner / 3);
    return kNone;
  }

  void find_edges() {
    before_.assign(mesh_.points.size(), kNone);
    behind_.assign(mesh_.points.size(), kNone);
    tangled_.assign(mesh_.points.size(), 0);
    for (const std::int32_t t : first_ids<std::int32_t>(mesh_.triangles.size()))
      for (std::size_t i = 0; i < 3; ++i) {
        const std::int32_t u = mesh_.triangles[t][i], v = mesh_.triangles[t][(i + 1) % 3];
        if (across(u, v) != kNone) continue;
        const auto e = static_cast<std::int32_t>(edges_.size());
        edges_.push_back({u, v, t});
        if (behind_[u] != kNone) tangled_[u] = 1;
        if (before_[v] != kNone) tangled_[v] = 1;
        behind_[u] = before_[v] = e;
      }
  }

  void join_segments(const std::function<bool(std::int32_t)>& is_corner) {
    ends_here_.assign(mesh_.points.size(), 0);
    DisjointSets<std::int32_t> joined(edges_.size());
    for (const Edge& edge : edges_) {
      const std::int32_t v = edge.from;
      if (before_[v] == kNone || behind_[v] == kNone || tangled_[v] != 0 ||
          (is_corner ? is_corner(v) : bends(before_[v], behind_[v])))
        ends_here_[v] = 1;
      else
        joined.join(before_[v], behind_[v]);
    }
    segments_.resize(edges_.size());
    for (const std::int32_t e : first_ids<std::int32_t>(edges_.size())) {
      Edge& edge = edges_[e];
      edge.segment = joined.find(e);
      if (ends_here_[edge.from] != 0) segments_[edge.segment].first = edge.from;
      if (ends_here_[edge.to] != 0) segments_[edge.segment].last = edge.to;
    }
  }

  [[nodiscard]] bool bends(std::int32_t e, std::int32_t next) const {
    constexpr double kStraight = 1e-6;
    const Point from = inward(e), to = inward(next);
    return std::fabs(cross(from, to)) > kStraight || dot(from, to) < 0;
  }

  [[nodiscard]] Point inward(std::int32_t e) const {
    const Point d = at(edges_[e].to) - at(edges_[e].from);
    const double length = std::sqrt(dot(d, d));
    return {-d.y / length, d.x / length};
  }

  /// From the end of an edge, where the domain surrounds it.
  void look_around(std::int32_t e) {
    const std::int32_t v = edges_[e].to, next = behind_[v];
    if (ends_here_[v] == 0 || tangled_[v] != 0 || next == kNone) return;
    const Point from = inward(e), to = inward(next);
    const double turn = std::atan2(-cross(from, to), dot(from, to));  // clockwise
    if (!(turn > 0)) return;
    const int parts = static_cast<int>(turn / kTurn) + 2;
    for (int k = 1; k < parts; ++k) {
      const double by = -turn * k / parts, sine = std::sin(by), cosine = std::cos(by);
      look_from({at(v), e, v}, {from.x * cosine - from.y * sine, from.x * sine + from.y * cosine});
    }
  }

  void look_from(const Foot& p, const Point& direction) {
    const std::optional<Foot> q = opposite(p, direction);
    if (!q || have_common_end(p, *q)) return;
    const Point center{p.at.x + radius_ * direction.x, p.at.y + radius_ * direction.y};
    const Point to_p = p.at - center, to_q = q->at - center;
    if (dot(to_p, to_q) > kOpposite * radius_ * radius_) return;
    const double width = 2 * radius_;
    if (width < rule_.narrowest) {
      ++report_.too_narrow;
      return;
    }
    ++report_.crossings;
    const int layers = layers_between(p, *q);
    report_.fewest = std::min(report_.fewest, layers);
    if (layers < rule_.layers)
      findings_.add(Flaw::kFewAcross, [&] {
        return formatted("{} from {} to {}, where the domain is {:.6g} wide", layers, place_words(p.at),
                         place_words(q->at), width);
      });
  }

  /// Where the disk that grows from a place in a direction touches the boundary again; its radius is in radius_.
  [[nodiscard]] std::optional<Foot> opposite(const Foot& p, const Point& direction) {
    constexpr double kTouches = 1e-7;
    constexpr int kMost = 200;
    radius_ = 2 * std::sqrt(squared_distance(box_.low, box_.high));
    std::int32_t found = kNone;
    Point foot{};
    for (int step = 0; step < kMost; ++step) {
      const Point center{p.at.x + radius_ * direction.x, p.at.y + radius_ * direction.y};
      const std::int32_t e = tree_.nearest(center, [&](std::int32_t i) {
        const Point &a = at(edges_[i].from), &b = at(edges_[i].to);
        return std::max(squared_distance_to_segment(center, a, b), Box::around(a, b).squared_distance(center));
      });
      const Point q = nearest_point_on_segment(center, at(edges_[e].from), at(edges_[e].to));
      const double distance = std::sqrt(squared_distance(center, q));
      const double ahead = dot(direction, q - p.at);
      if (distance >= radius_ * (1 - kTouches) || !(ahead > 0)) break;
      radius_ = squared_distance(p.at, q) / (2 * ahead);
      found = e;
      foot = q;
    }
    if (found == kNone) return std::nullopt;
    const Edge& edge = edges_[found];
    const std::int32_t vertex = foot == at(edge.from) ? edge.from : foot == at(edge.to) ? edge.to : kNone;
    return Foot{foot, found, vertex};
  }

  /// Also one segment with itself.
  [[nodiscard]] bool have_common_end(const Foot& p, const Foot& q) const {
    for (const std::int32_t s : segments_at(p))
      for (const std::int32_t t : segments_at(q)) {
        if (s == kNone || t == kNone) continue;
        const Ends &a = segments_[s], &b = segments_[t];
        const auto is_end_of_b = [&](std::int32_t v) { return v != kNone && (v == b.first || v == b.last); };
        if (s == t || is_end_of_b(a.first) || is_end_of_b(a.last)) return true;
      }
    return false;
  }

  [[nodiscard]] std::array<std::int32_t, 2> segments_at(const Foot& foot) const {
    std::array<std::int32_t, 2> found{edges_[foot.edge].segment, kNone};
    if (foot.vertex == kNone) return found;
    for (const std::int32_t e : {before_[foot.vertex], behind_[foot.vertex]})
      if (e != kNone && edges_[e].segment != found[0]) found[1] = edges_[e].segment;
    return found;
  }

  /// Of triangles, at most one more than asked for. Each triangle that the chord passes adds a vertex, which is one
  /// edge farther from the bank than the nearer end of the edge that leads into it, but not along the boundary.
  [[nodiscard]] int layers_between(const Foot& p, const Foot& q) const {
    std::int32_t left = edges_[p.edge].from, right = edges_[p.edge].to;
    int at_left = 0, at_right = 0;
    if (p.vertex != kNone) {
      std::tie(right, left) = opposite_edge(p.vertex, q.at);
      if (q.vertex != kNone && (q.vertex == left || q.vertex == right)) return 1;
      at_left = at_right = 1;
    }
    while (std::min(at_left, at_right) < rule_.layers) {
      const std::int32_t t = across(right, left);
      if (t == kNone) break;
      const std::int32_t apex = apex_of(t, left, right);
      const bool is_left = orient2d(p.at, q.at, at(apex)) > 0;
      const bool is_beside_bank = (is_left ? across(apex, left) : across(right, apex)) == kNone;
      const int at_apex = (is_beside_bank ? (is_left ? at_right : at_left) : std::min(at_left, at_right)) + 1;
      if (q.vertex == apex) return at_apex;
      (is_left ? left : right) = apex;
      (is_left ? at_left : at_right) = at_apex;
    }
    return std::min(at_left, at_right);
  }

  /// Of the triangle at a vertex in the direction of a point.
  [[nodiscard]] std::pair<std::int32_t, std::int32_t> opposite_edge(std::int32_t v, const Point& toward) const {
    std::pair<std::int32_t, std::int32_t> found{v, v};
    for (const std::uint32_t corner : corners_.around(v)) {
      const auto& vertices = mesh_.triangles[corner / 3];
      const std::int32_t next = vertices[(corner % 3 + 1) % 3], previous = vertices[(corner % 3 + 2) % 3];
      if (orient2d(at(v), at(next), toward) >= 0 && orient2d(at(v), at(previous), toward) <= 0)
        found = {next, previous};
    }
    return found;
  }

  [[nodiscard]] std::int32_t apex_of(std::int32_t t, std::int32_t u, std::int32_t v) const {
    for (const std::int32_t vertex : mesh_.triangles[t])
      if (vertex != u && vertex != v) return vertex;
    return kNone;
  }

  const Mesh& mesh_;
  CornerTable corners_;
  AcrossRule rule_;
  Findings& findings_;
  std::vector<Edge> edges_;
  std::vector<Ends> segments_;                 // by edge: that of the segment which the edge stands for
  std::vector<std::int32_t> before_, behind_;  // edges at each vertex
  std::vector<char> tangled_, ends_here_;      // vertices
  Box box_;
  BoxTree tree_;
  double radius_ = 0;
  AcrossReport report_;
};

}  // namespace

AcrossReport check_across(const Mesh& mesh, const std::function<bool(std::int32_t)>& is_corner, const AcrossRule& rule,
                          Findings& findings) {
  return Channels(mesh, is_corner, rule, findings).check();
}

}  // namespace driftmesh
