#include "io/boundary_strings.hpp"

#include <algorithm>
#include <cstddef>
#include <map>
#include <optional>
#include <utility>

#include "geometry/predicates.hpp"
#include "mesh/mesh_edges.hpp"

namespace driftmesh {
namespace {

/// An edge of a triangle, from corner `i` + 1 to corner `i` + 2.
struct Side {
  std::size_t triangle = 0;
  std::size_t i = 0;  ///< the corner opposite of it
};

/// An edge of the boundary.
struct BorderEdge {
  std::int32_t from = 0;
  EdgeType type;
  std::uint32_t order = 0;  ///< the index into mesh.edges; behind all others if it is not there
};
using Ring = std::vector<BorderEdge>;

class RingWalker {
 public:
  RingWalker(const Mesh& mesh, const TypeOfEdge& type_of)
      : mesh_(mesh),
        type_of_(type_of),
        neighbors_(triangle_neighbors(mesh)),
        edges_(mesh),
        walked_(mesh.triangles.size(), {false, false, false}) {
    find_touched();
  }

  std::vector<Ring> rings() {
    std::vector<Ring> rings;
    for_each_border_side([&](Side side) {
      if (!walked_[side.triangle][side.i]) split_into(rings, walk_from(side));
    });
    return rings;
  }

  [[nodiscard]] std::vector<std::int32_t> touched() const {
    std::vector<std::int32_t> vertices;
    for (const auto& [vertex, fans] : fans_) vertices.push_back(vertex);
    return vertices;
  }

 private:
  /// The triangles around a vertex between two edges of the boundary.
  struct Fan {
    Side out;  ///< side that leaves the vertex, at the right end of the fan
    Side in;   ///< side that enters the vertex, at its left end
  };

  template <class Visit>
  void for_each_border_side(const Visit& visit) const {
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t)
      for (std::size_t i = 0; i < 3; ++i)
        if (!across(Side{t, i})) visit(Side{t, i});
  }

  void find_touched() {
    std::vector<bool> seen(mesh_.points.size(), false);
    for_each_border_side([&](Side side) {
      const auto end = static_cast<std::size_t>(end_of(side));
      if (seen[end]) fans_[end_of(side)];
      seen[end] = true;
    });
    if (fans_.empty()) return;
    for_each_border_side([&](Side side) {
      if (const auto found = fans_.find(end_of(side)); found != fans_.end())
        found->second.push_back({across_fan(side), side});
    });
    for (auto& [vertex, fans] : fans_) sort_around(vertex, fans);
  }

  /// Counterclockwise, beginning to the right of the vertex.
  void sort_around(std::int32_t vertex, std::vector<Fan>& fans) const {
    const Point center = mesh_.points[static_cast<std::size_t>(vertex)];
    const auto place = [&](const Fan& fan) { return mesh_.points[static_cast<std::size_t>(end_of(fan.out))]; };
    const auto is_below = [&](Point p) { return p.y < center.y || (p.y == center.y && p.x < center.x); };
    std::ranges::stable_sort(fans, [&](const Fan& a, const Fan& b) {
      const Point p = place(a), q = place(b);
      if (is_below(p) != is_below(q)) return is_below(q);
      return orient2d(center, p, q) > 0;
    });
  }

  Ring walk_from(Side side) {
    Ring ring;
    for (; !walked_[side.triangle][side.i]; side = after(side)) {
      walked_[side.triangle][side.i] = true;
      const std::int32_t from = start_of(side), to = end_of(side), edge = edges_.find(from, to);
      ring.push_back({from, type_of_(from, to, edge), static_cast<std::uint32_t>(edge)});
    }
    return ring;
  }

  /// The next edge of the boundary, around what is outside of the domain: an island that touches another boundary in a
  /// vertex continues there.
  [[nodiscard]] Side after(Side side) const {
    const auto found = fans_.find(end_of(side));
    if (found == fans_.end()) return across_fan(side);
    const std::vector<Fan>& fans = found->second;
    const auto own = std::ranges::find_if(
        fans, [&](const Fan& fan) { return fan.in.triangle == side.triangle && fan.in.i == side.i; });
    return (own + 1 == fans.end() ? fans.front() : *(own + 1)).out;
  }

  /// The edge of the boundary that the triangles around the end of this one lead to.
  [[nodiscard]] Side across_fan(Side side) const {
    for (;;) {
      const Side next{side.triangle, (side.i + 1) % 3};
      const auto met = across(next);
      if (!met) return next;
      side = *met;
    }
  }

  /// The same edge in the triangle on its other side, which passes it in the other direction: in a broken mesh,
  /// triangles that pass an edge in the same direction bound the domain there.
  [[nodiscard]] std::optional<Side> across(Side side) const {
    const std::int32_t other = neighbors_[side.triangle][side.i], from = start_of(side), to = end_of(side);
    if (other < 0 || from == to) return std::nullopt;
    for (std::size_t j = 0; j < 3; ++j)
      if (const Side met{static_cast<std::size_t>(other), j}; start_of(met) == to && end_of(met) == from) return met;
    return std::nullopt;
  }

  /// Cuts a closed walk into rings where it comes back to a vertex: the domain, or an island, touches itself there.
  void split_into(std::vector<Ring>& rings, const Ring& walk) const {
    Ring open;
    std::map<std::int32_t, std::size_t> places;  // in `open`, of vertices where boundaries touch
    for (const BorderEdge& edge : walk) {
      if (fans_.contains(edge.from)) {
        const auto [known, is_new] = places.try_emplace(edge.from, open.size());
        if (!is_new) {
          const auto begin = open.begin() + static_cast<std::ptrdiff_t>(known->second);
          rings.emplace_back(begin, open.end());
          open.erase(begin, open.end());
          std::erase_if(places, [&](const auto& place) { return place.second > open.size(); });
        }
      }
      open.push_back(edge);
    }
    rings.push_back(std::move(open));
  }

  [[nodiscard]] std::int32_t start_of(Side s) const { return mesh_.triangles[s.triangle][(s.i + 1) % 3]; }
  [[nodiscard]] std::int32_t end_of(Side s) const { return mesh_.triangles[s.triangle][(s.i + 2) % 3]; }

  const Mesh& mesh_;
  const TypeOfEdge& type_of_;
  TriangleNeighbors neighbors_;
  ConstrainedEdgeIndex edges_;
  std::vector<std::array<bool, 3>> walked_;
  std::map<std::int32_t, std::vector<Fan>> fans_;  // around vertices in which boundaries touch
};

/// Twice the area on the left, from near the ring, where less is rounded away.
double doubled_area(const Mesh& mesh, const Ring& ring) {
  const auto point = [&](std::size_t i) { return mesh.points[static_cast<std::size_t>(ring[i % ring.size()].from)]; };
  const Point origin = point(0);
  double sum = 0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Point a = point(i), b = point(i + 1);
    sum += (a.x - origin.x) * (b.y - origin.y) - (b.x - origin.x) * (a.y - origin.y);
  }
  return sum;
}

/// A string, and its place among all of them.
struct Placed {
  std::uint32_t order = 0;
  BoundaryString string;
};

/// `count` edges of a ring from edge `begin` on, which are less than all.
Placed chain(const Ring& ring, std::size_t begin, std::size_t count) {
  Placed placed{ring[begin].order, {ring[begin].type.type, false, {}}};
  for (std::size_t i = begin; i < begin + count; ++i) {
    placed.order = std::min(placed.order, ring[i].order);
    placed.string.vertices.push_back(ring[i].from);
  }
  placed.string.vertices.push_back(ring[(begin + count) % ring.size()].from);
  return placed;
}

/// A ring whose edges are all of one type.
void append_whole(const Mesh& mesh, Ring ring, std::vector<Placed>& strings) {
  std::rotate(ring.begin(), std::ranges::min_element(ring, {}, &BorderEdge::order), ring.end());
  std::int32_t type = ring.front().type.type;
  if (type == kMainlandType && doubled_area(mesh, ring) < 0) type = kIslandType;
  if (!is_closed_type(type)) {
    const std::size_t half = ring.size() / 2;
    strings.push_back(chain(ring, 0, half));
    strings.push_back(chain(ring, half, ring.size() - half));
    return;
  }
  Placed island{ring.front().order, {type, true, {}}};
  for (const BorderEdge& edge : ring) island.string.vertices.push_back(edge.from);
  strings.push_back(std::move(island));
}

void append_strings(const Mesh& mesh, Ring ring, std::vector<Placed>& strings) {
  if (std::ranges::adjacent_find(ring, std::not_equal_to(), &BorderEdge::type) == ring.end())
    return append_whole(mesh, std::move(ring), strings);
  for (BorderEdge& edge : ring)
    if (is_closed_type(edge.type.type)) edge.type.type -= 1;
  const auto change = std::ranges::adjacent_find(ring, std::not_equal_to(), &BorderEdge::type);
  if (change == ring.end()) return append_whole(mesh, std::move(ring), strings);
  std::rotate(ring.begin(), change + 1, ring.end());  // so that a string begins with it
  for (std::size_t begin = 0, end = 0; begin < ring.size(); begin = end) {
    while (end < ring.size() && ring[end].type == ring[begin].type) ++end;
    strings.push_back(chain(ring, begin, end - begin));
  }
}

}  // namespace

bool is_closed_type(std::int32_t type) {
  return type == kIslandType || type == 11 || type == 21;
}

Boundary boundary_of(const Mesh& mesh, const TypeOfEdge& type_of) {
  RingWalker walker(mesh, type_of);
  std::vector<Placed> placed;
  for (Ring& ring : walker.rings()) append_strings(mesh, std::move(ring), placed);
  std::ranges::stable_sort(placed, {}, &Placed::order);
  Boundary boundary{{}, walker.touched()};
  for (Placed& string : placed) boundary.strings.push_back(std::move(string.string));
  return boundary;
}

}  // namespace driftmesh
