#include "io/boundary_strings.hpp"

#include <algorithm>
#include <cstddef>

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
  bool open = false;
};
using Ring = std::vector<BorderEdge>;

class RingWalker {
 public:
  RingWalker(const Mesh& mesh, const std::function<bool(std::int32_t)>& is_open)
      : mesh_(mesh),
        is_open_(is_open),
        neighbors_(triangle_neighbors(mesh)),
        edges_(mesh),
        walked_(mesh.triangles.size(), {false, false, false}) {}

  std::vector<Ring> rings() {
    std::vector<Ring> rings;
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t)
      for (std::size_t i = 0; i < 3; ++i)
        if (neighbors_[t][i] < 0 && !walked_[t][i]) rings.push_back(ring_from({t, i}));
    return rings;
  }

 private:
  Ring ring_from(Side side) {
    Ring ring;
    for (; !walked_[side.triangle][side.i]; side = after(side)) {
      walked_[side.triangle][side.i] = true;
      const std::int32_t from = start_of(side), edge = edges_.find(from, end_of(side));
      ring.push_back({from, is_open_(edge < 0 ? 0 : mesh_.edges[static_cast<std::size_t>(edge)].marker)});
    }
    return ring;
  }

  /// The edge of the boundary that the triangles around the end of this one lead to.
  [[nodiscard]] Side after(Side side) const {
    const std::int32_t around = end_of(side);
    std::size_t corner = (side.i + 2) % 3;
    for (;;) {
      const Side next{side.triangle, (corner + 2) % 3};  // leaves the corner
      const std::int32_t across = neighbors_[next.triangle][next.i];
      if (across < 0) return next;
      side.triangle = static_cast<std::size_t>(across);
      const auto& corners = mesh_.triangles[side.triangle];
      corner = static_cast<std::size_t>(std::ranges::find(corners, around) - corners.begin());
    }
  }

  [[nodiscard]] std::int32_t start_of(Side s) const { return mesh_.triangles[s.triangle][(s.i + 1) % 3]; }
  [[nodiscard]] std::int32_t end_of(Side s) const { return mesh_.triangles[s.triangle][(s.i + 2) % 3]; }

  const Mesh& mesh_;
  const std::function<bool(std::int32_t)>& is_open_;
  TriangleNeighbors neighbors_;
  ConstrainedEdgeIndex edges_;
  std::vector<std::array<bool, 3>> walked_;
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

/// A ring whose edges are all alike.
BoundaryString whole(const Mesh& mesh, const Ring& ring) {
  using Kind = BoundaryString::Kind;
  const bool is_island = doubled_area(mesh, ring) < 0;
  BoundaryString string{ring.front().open ? Kind::kOpen : is_island ? Kind::kIsland : Kind::kLand, {}};
  for (const BorderEdge& edge : ring) string.vertices.push_back(edge.from);
  if (string.kind != Kind::kIsland) string.vertices.push_back(ring.front().from);
  return string;
}

void append_strings(const Mesh& mesh, Ring ring, std::vector<BoundaryString>& strings) {
  const auto change = std::ranges::adjacent_find(ring, std::not_equal_to(), &BorderEdge::open);
  if (change == ring.end()) return strings.push_back(whole(mesh, ring));
  std::rotate(ring.begin(), change + 1, ring.end());  // so that a string begins with it
  for (std::size_t i = 0; i < ring.size(); ++i) {
    if (i == 0 || ring[i].open != ring[i - 1].open)
      strings.push_back({ring[i].open ? BoundaryString::Kind::kOpen : BoundaryString::Kind::kLand, {ring[i].from}});
    strings.back().vertices.push_back(ring[(i + 1) % ring.size()].from);
  }
}

}  // namespace

std::vector<BoundaryString> boundary_strings(const Mesh& mesh, const std::function<bool(std::int32_t)>& is_open) {
  std::vector<BoundaryString> strings;
  for (const Ring& ring : RingWalker(mesh, is_open).rings()) append_strings(mesh, ring, strings);
  return strings;
}

}  // namespace driftmesh
