#include "patch/flaws.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <tuple>
#include <utility>
#include <vector>

#include "base/formatted.hpp"
#include "driftmesh/id_vector.hpp"
#include "geometry/box.hpp"
#include "geometry/box_tree.hpp"
#include "geometry/predicates.hpp"
#include "geometry/segment_geometry.hpp"

namespace driftmesh::patch {
namespace {

void require_length(std::size_t length, std::size_t expected, const char* what) {
  if (length != 0 && length != expected)
    throw Error(formatted("there are {} {} where {} are expected", length, what, expected));
}

std::string place_text(const Point& p) {
  return formatted("({}, {})", p.x, p.y);
}

/// An edge from a to b, on whose left the triangle is.
struct DirectedEdge {
  std::int32_t a, b, triangle;
};

std::tuple<std::int32_t, std::int32_t> end_numbers(const DirectedEdge& side) {
  return {side.a, side.b};
}

std::vector<DirectedEdge> directed_edges(const Mesh& mesh) {
  std::vector<DirectedEdge> sides;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t i = 0; i < 3; ++i)
      sides.push_back({mesh.triangles[t][i], mesh.triangles[t][(i + 1) % 3], static_cast<std::int32_t>(t)});
  std::ranges::stable_sort(sides, {}, end_numbers);
  return sides;
}

class FlawSearch {
 public:
  explicit FlawSearch(const Mesh& mesh) : mesh_(mesh), sides_(directed_edges(mesh)) {}

  std::string run() {
    for (const auto find : {&FlawSearch::turned, &FlawSearch::flat, &FlawSearch::same_side, &FlawSearch::same_place,
                            &FlawSearch::point_on_edge, &FlawSearch::crossing})
      if (std::string flaw = (this->*find)(); !flaw.empty()) return flaw;
    return {};
  }

 private:
  [[nodiscard]] const Point& place(std::int32_t v) const { return mesh_.points[to_index(v)]; }
  [[nodiscard]] double orientation(std::size_t t) const {
    const auto& [a, b, c] = mesh_.triangles[t];
    return orient2d(place(a), place(b), place(c));
  }
  [[nodiscard]] std::string point_words(std::int32_t v) const {
    return formatted("point {} ", v) + place_text(place(v));
  }
  [[nodiscard]] std::string edge_words(const DirectedEdge& s) const {
    return "the edge from " + point_words(s.a) + " to " + point_words(s.b);
  }

  /// A reader turns all triangles around if most are clockwise, so that nobody knows which ones were so in a file.
  [[nodiscard]] std::string turned() const {
    std::size_t count = 0, first = 0;
    for (std::size_t t = mesh_.triangles.size(); t-- > 0;)
      if (orientation(t) < 0) {
        ++count;
        first = t;
      }
    if (count == 0) return {};
    if (count == mesh_.triangles.size()) return "all triangles are clockwise; they must be counterclockwise";
    return formatted(
        "corners of {} of {} triangles run in the other direction than those of the others, first those of triangle "
        "{} (counted from 0); all must be counterclockwise",
        count, mesh_.triangles.size(), first);
  }

  [[nodiscard]] std::string flat() const {
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t)
      if (const auto& [a, b, c] = mesh_.triangles[t]; orientation(t) == 0)
        return formatted("triangle {} ({} {} {}; counted from 0) is flat", t, a, b, c);
    return {};
  }

  [[nodiscard]] std::string same_side() const {
    const auto twice = std::ranges::adjacent_find(sides_, {}, end_numbers);
    if (twice == sides_.end()) return {};
    const DirectedEdge &one = twice[0], &other = twice[1];
    const auto corners = [&](const DirectedEdge& side) {
      std::array<std::int32_t, 3> sorted = mesh_.triangles[to_index(side.triangle)];
      std::ranges::sort(sorted);
      return sorted;
    };
    const std::string both = formatted("triangles {} and {} (counted from 0) ", one.triangle, other.triangle);
    if (corners(one) == corners(other)) return both + "have the same corners";
    return both + "lie on the same side of " + edge_words(one);
  }

  [[nodiscard]] std::string same_place() const {
    std::vector<std::int32_t> used;
    for (const DirectedEdge& side : sides_)
      if (used.empty() || used.back() != side.a) used.push_back(side.a);
    const auto coordinates = [&](std::int32_t v) { return std::pair(place(v).x, place(v).y); };
    std::ranges::stable_sort(used, {}, coordinates);
    const auto twice = std::ranges::adjacent_find(used, {}, coordinates);
    if (twice == used.end()) return {};
    return formatted("points {} and {} (counted from 0) are both at ", twice[0], twice[1]) +
           place_text(place(twice[0])) + "; triangles that meet there must share one";
  }

  [[nodiscard]] std::vector<DirectedEdge> boundary() const {
    std::vector<DirectedEdge> open;
    for (const DirectedEdge& side : sides_)
      if (!std::ranges::binary_search(sides_, std::tuple(side.b, side.a), {}, end_numbers)) open.push_back(side);
    return open;
  }

  [[nodiscard]] std::vector<Box> boxes_of(const std::vector<DirectedEdge>& sides) const {
    std::vector<Box> boxes;
    for (const DirectedEdge& s : sides) boxes.push_back(Box::around(place(s.a), place(s.b), rounding()));
    return boxes;
  }

  /// As far as midpoints lie beside their edges.
  [[nodiscard]] double rounding() const {
    Box box;
    for (const DirectedEdge& side : sides_) box.extend(place(side.a));
    const double most =
        std::max({std::fabs(box.low.x), std::fabs(box.low.y), std::fabs(box.high.x), std::fabs(box.high.y)});
    return 4 * std::numeric_limits<double>::epsilon() * most;
  }

  [[nodiscard]] std::string point_on_edge() const {
    const std::vector<DirectedEdge> open = boundary();
    const BoxTree tree(boxes_of(open));
    const double near = rounding();
    for (const DirectedEdge& side : open) {
      const Point& p = place(side.a);
      std::string flaw;
      tree.visit_containing(p, [&](std::int32_t i) {
        const DirectedEdge& edge = open[to_index(i)];
        if (!flaw.empty() || side.a == edge.a || side.a == edge.b) return;
        if (squared_distance_to_segment(p, place(edge.a), place(edge.b)) <= near * near)
          flaw = point_words(side.a) + " lies on " + edge_words(edge) + ", which " +
                 formatted("triangle {} has as a whole (counted from 0)", edge.triangle);
      });
      if (!flaw.empty()) return flaw;
    }
    return {};
  }

  [[nodiscard]] std::string crossing() const {
    const std::vector<DirectedEdge> open = boundary();
    std::pair<std::int32_t, std::int32_t> first{kNone, kNone};
    BoxTree(boxes_of(open)).visit_overlapping([&](std::int32_t i, std::int32_t j) {
      if (first.first != kNone && first <= std::pair(i, j)) return;
      const DirectedEdge &s = open[to_index(i)], &t = open[to_index(j)];
      const auto apart = [&](const DirectedEdge& line, const DirectedEdge& other) {
        const double p = orient2d(place(line.a), place(line.b), place(other.a));
        const double q = orient2d(place(line.a), place(line.b), place(other.b));
        return (p > 0 && q < 0) || (p < 0 && q > 0);
      };
      if (apart(s, t) && apart(t, s)) first = {i, j};
    });
    if (first.first == kNone) return {};
    return edge_words(open[to_index(first.first)]) + " crosses that from " +
           point_words(open[to_index(first.second)].a) + " to " + point_words(open[to_index(first.second)].b) +
           " (counted from 0), so that triangles overlap";
  }

  const Mesh& mesh_;
  std::vector<DirectedEdge> sides_;  // those of all triangles, by their ends
};

}  // namespace

void require_sound(const Mesh& mesh) {
  const std::size_t points = mesh.points.size(), triangles = mesh.triangles.size();
  require_length(mesh.point_markers.size(), points, "point markers");
  require_length(mesh.regions.size(), triangles, "regions");
  require_length(mesh.subdomains.size(), triangles, "subdomains");
  if (triangles == 0) throw Error("there are no triangles, of which a mesh could be made");
  const auto valid = [&](std::int32_t v) { return to_index(v) < points; };
  for (std::size_t t = 0; t < triangles; ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    if (!valid(a) || !valid(b) || !valid(c) || a == b || b == c || c == a)
      throw Error(formatted("triangle {} ({} {} {}; counted from 0): three different points below {} are expected", t,
                            a, b, c, points) +
                  "; driftmesh check lists all such triangles");
    for (const std::int32_t v : mesh.triangles[t])
      if (const Point& p = mesh.points[to_index(v)]; !in_coordinate_range(p.x) || !in_coordinate_range(p.y))
        throw Error(formatted("point {} ({}, {}; counted from 0) is not finite or out of range", v, p.x, p.y));
  }
  for (std::size_t e = 0; e < mesh.edges.size(); ++e)
    if (const auto& [a, b, marker] = mesh.edges[e]; !valid(a) || !valid(b) || a == b)
      throw Error(
          formatted("edge {} ({} {}; counted from 0): two different points below {} are expected", e, a, b, points));
  for (const Mesh::Weir& weir : mesh.weirs)
    if (!std::ranges::all_of(weir.points, valid) || !std::ranges::all_of(weir.across, valid))
      throw Error(formatted("a weir names a point that is not below {}", points));
}

std::string find_flaw(const Mesh& mesh) {
  return FlawSearch(mesh).run();
}

}  // namespace driftmesh::patch
