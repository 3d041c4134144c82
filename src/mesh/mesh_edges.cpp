#include "mesh/mesh_edges.hpp"

#include <algorithm>
#include <bit>
#include <utility>

#include "base/disjoint_sets.hpp"
#include "base/narrow.hpp"
#include "driftmesh/id_vector.hpp"

namespace driftmesh {
namespace {

// Half-edge h = 3 t + i is the edge of triangle t opposite its vertex i.
struct Ends {
  std::int32_t low;
  std::int32_t high;
};

Ends ends_of(const Mesh& mesh, std::uint32_t h) {
  const auto& triangle = mesh.triangles[h / 3];
  const std::uint32_t i = h % 3;
  const std::int32_t a = triangle[i == 2 ? 0 : i + 1];
  const std::int32_t b = triangle[i == 0 ? 2 : i - 1];
  return {std::min(a, b), std::max(a, b)};
}

struct Buckets {
  std::vector<std::uint32_t> first;  // for each vertex, and one past the last
  std::vector<std::uint32_t> half_edges;
};

Buckets bucket_by_low_vertex(const Mesh& mesh, std::uint32_t half_edge_count) {
  Buckets buckets;
  buckets.first.assign(mesh.points.size() + 1, 0);
  for (std::uint32_t h = 0; h < half_edge_count; ++h) ++buckets.first[ends_of(mesh, h).low + 1];
  for (std::size_t v = 1; v < buckets.first.size(); ++v) buckets.first[v] += buckets.first[v - 1];
  buckets.half_edges.resize(half_edge_count);
  std::vector<std::uint32_t> next(buckets.first.begin(), buckets.first.end() - 1);
  for (std::uint32_t h = 0; h < half_edge_count; ++h) buckets.half_edges[next[ends_of(mesh, h).low]++] = h;
  return buckets;
}

void link(TriangleNeighbors& neighbors, std::uint32_t g, std::uint32_t h) {
  neighbors[g / 3][g % 3] = static_cast<std::int32_t>(h / 3);
  neighbors[h / 3][h % 3] = static_cast<std::int32_t>(g / 3);
}

}  // namespace

TriangleNeighbors triangle_neighbors(const Mesh& mesh) {
  const auto half_edge_count = narrow<std::uint32_t>(3 * mesh.triangles.size(), "edges of all triangles");
  const Buckets buckets = bucket_by_low_vertex(mesh, half_edge_count);
  TriangleNeighbors neighbors(mesh.triangles.size(), {-1, -1, -1});
  struct Waiting {
    std::int32_t low = -1;
    std::uint32_t half_edge = 0;
  };
  std::vector<Waiting> waiting(mesh.points.size());  // by high vertex: an edge (low, high) seen once so far
  for (std::uint32_t h : buckets.half_edges) {
    const Ends edge = ends_of(mesh, h);
    Waiting& other = waiting[edge.high];
    if (other.low == edge.low) {
      link(neighbors, other.half_edge, h);
      other.low = -1;
    } else {
      other = {edge.low, h};
    }
  }
  return neighbors;
}

ConstrainedEdgeIndex::ConstrainedEdgeIndex(const Mesh& mesh) : edges_(mesh.edges), on_edge_(mesh.points.size(), false) {
  slots_.assign(std::bit_ceil(2 * mesh.edges.size() + 1), -1);
  for (std::size_t i = 0; i < edges_.size(); ++i) {
    const auto [low, high] = std::minmax(edges_[i].a, edges_[i].b);
    on_edge_[low] = on_edge_[high] = true;
    if (look_up(low, high) != -1) continue;
    std::size_t slot = home_slot(low, high);
    while (slots_[slot] != -1) slot = (slot + 1) & (slots_.size() - 1);
    slots_[slot] = static_cast<std::int32_t>(i);
  }
}

std::size_t ConstrainedEdgeIndex::home_slot(std::int32_t low, std::int32_t high) const {
  const std::uint64_t key = (static_cast<std::uint64_t>(low) << 32) | static_cast<std::uint32_t>(high);
  return ((key * 0x9e3779b97f4a7c15u) >> 20) & (slots_.size() - 1);
}

std::int32_t ConstrainedEdgeIndex::look_up(std::int32_t a, std::int32_t b) const {
  const auto [low, high] = std::minmax(a, b);
  for (std::size_t slot = home_slot(low, high); slots_[slot] != -1; slot = (slot + 1) & (slots_.size() - 1)) {
    const Mesh::Edge& edge = edges_[slots_[slot]];
    if (std::min(edge.a, edge.b) == low && std::max(edge.a, edge.b) == high) return slots_[slot];
  }
  return -1;
}

std::vector<std::array<std::int32_t, 2>> triangles_at_edges(const Mesh& mesh, const ConstrainedEdgeIndex& index) {
  std::vector<std::array<std::int32_t, 2>> at_edges(mesh.edges.size(), {-1, -1});
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& triangle = mesh.triangles[t];
    for (std::size_t i = 0; i < 3; ++i) {
      const std::int32_t from = triangle[(i + 1) % 3];
      const std::int32_t edge = index.find(from, triangle[(i + 2) % 3]);
      if (edge != -1) at_edges[edge][mesh.edges[edge].a == from ? 0 : 1] = static_cast<std::int32_t>(t);
    }
  }
  return at_edges;
}

std::vector<std::int32_t> boundary_edges(const Mesh& mesh) {
  std::vector<std::int32_t> boundary;
  const auto at_edges = triangles_at_edges(mesh, ConstrainedEdgeIndex(mesh));
  for (std::size_t e = 0; e < at_edges.size(); ++e)
    if ((at_edges[e][0] < 0) != (at_edges[e][1] < 0)) boundary.push_back(static_cast<std::int32_t>(e));
  return boundary;
}

std::vector<Mesh::Edge> separator_edges(const Mesh& mesh, const TriangleNeighbors& neighbors,
                                        const ConstrainedEdgeIndex& index, std::int32_t marker) {
  std::vector<Mesh::Edge> edges;
  if (mesh.subdomains.empty()) return edges;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t i = 0; i < 3; ++i) {
      const std::int32_t other = neighbors[t][i];
      if (other < 0 || std::cmp_greater(other, t) || mesh.subdomains[other] == mesh.subdomains[t]) continue;
      const std::int32_t a = mesh.triangles[t][(i + 1) % 3], b = mesh.triangles[t][(i + 2) % 3];
      if (index.find(a, b) < 0) edges.push_back({a, b, marker});
    }
  return edges;
}

std::vector<std::int32_t> parts_between_edges(const Mesh& mesh) {
  const TriangleNeighbors neighbors = triangle_neighbors(mesh);
  const ConstrainedEdgeIndex index(mesh);
  DisjointSets<std::int32_t> sets(mesh.triangles.size());
  for (const std::int32_t t : first_ids<std::int32_t>(mesh.triangles.size()))
    for (std::size_t i = 0; i < 3; ++i) {
      const auto& corners = mesh.triangles[t];
      if (neighbors[t][i] >= 0 && index.find(corners[(i + 1) % 3], corners[(i + 2) % 3]) < 0)
        sets.join(t, neighbors[t][i]);
    }
  std::vector<std::int32_t> parts(mesh.triangles.size());
  std::int32_t next = 0;
  for (const std::int32_t t : first_ids<std::int32_t>(mesh.triangles.size())) {
    const std::int32_t first = sets.find(t);  // the lowest of its set
    parts[t] = first == t ? next++ : parts[first];
  }
  return parts;
}

}  // namespace driftmesh
