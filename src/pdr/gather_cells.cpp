#include "pdr/gather_cells.hpp"

#include <algorithm>
#include <span>
#include <unordered_map>
#include <utility>

#include "base/narrow.hpp"
#include "distributed/mesh_bytes.hpp"
#include "driftmesh/error.hpp"
#include "mesh/to_piece.hpp"
#include "pdr/point_hash.hpp"

namespace driftmesh::pdr {
namespace {

using Ends = std::pair<std::int32_t, std::int32_t>;

/// Keeps the points that triangles use, and those of the input, in their order.
void drop_unused_points(Mesh& mesh, std::size_t inputs) {
  constexpr std::int32_t kUnused = -1;
  std::vector<std::int32_t> place(mesh.points.size(), kUnused);
  std::fill_n(place.begin(), inputs, 0);
  for (const auto& t : mesh.triangles)
    for (const std::int32_t v : t) place[v] = 0;
  std::int32_t kept = 0;
  for (std::size_t v = 0; v < place.size(); ++v) {
    if (place[v] == kUnused) continue;
    mesh.points[kept] = mesh.points[v];
    mesh.point_markers[kept] = mesh.point_markers[v];
    place[v] = kept++;
  }
  mesh.points.resize(kept);
  mesh.point_markers.resize(kept);
  for (auto& t : mesh.triangles)
    for (std::int32_t& v : t) v = place[v];
  for (Mesh::Edge& e : mesh.edges) e.a = place[e.a], e.b = place[e.b];
}

/// Puts pieces together: points at the same place are one.
class Joining {
 public:
  explicit Joining(Mesh& whole) : whole_(whole) {}

  void add(const Mesh& piece) {
    std::vector<std::int32_t> place;
    place.reserve(piece.points.size());
    for (std::size_t v = 0; v < piece.points.size(); ++v) place.push_back(place_of(piece, v));
    for (const auto& t : piece.triangles) whole_.triangles.push_back({place[t[0]], place[t[1]], place[t[2]]});
    whole_.regions.insert(whole_.regions.end(), piece.regions.begin(), piece.regions.end());
    for (const Mesh::Edge& e : piece.edges) whole_.edges.push_back({place[e.a], place[e.b], e.marker});
  }

  /// Takes edges once that two pieces have.
  void finish() {
    const auto ends = [](const Mesh::Edge& e) { return std::minmax(e.a, e.b); };
    std::sort(whole_.edges.begin(), whole_.edges.end(),
              [&](const auto& e, const auto& f) { return ends(e) < ends(f); });
    const auto same = [&](const auto& e, const auto& f) { return ends(e) == ends(f); };
    whole_.edges.erase(std::unique(whole_.edges.begin(), whole_.edges.end(), same), whole_.edges.end());
  }

 private:
  std::int32_t place_of(const Mesh& piece, std::size_t v) {
    const auto [at, fresh] = place_of_.try_emplace(piece.points[v], static_cast<std::int32_t>(whole_.points.size()));
    if (fresh) {
      whole_.points.push_back(piece.points[v]);
      whole_.point_markers.push_back(piece.point_markers[v]);
    }
    return at->second;
  }

  Mesh& whole_;
  std::unordered_map<Point, std::int32_t, PointHash> place_of_;
};

/// Every edge of a triangle has another triangle on its other side, or is constrained.
bool fits_together(const Mesh& mesh) {
  std::vector<Ends> edges;
  edges.reserve(3 * mesh.triangles.size());
  for (const auto& t : mesh.triangles)
    for (int i = 0; i < 3; ++i) edges.emplace_back(t[i], t[next(i)]);
  std::sort(edges.begin(), edges.end());
  if (std::adjacent_find(edges.begin(), edges.end()) != edges.end()) return false;
  std::vector<Ends> constrained;
  for (const Mesh::Edge& e : mesh.edges) constrained.push_back(std::minmax(e.a, e.b));
  return std::all_of(edges.begin(), edges.end(), [&](const Ends& e) {
    return std::binary_search(edges.begin(), edges.end(), Ends(e.second, e.first)) ||
           std::binary_search(constrained.begin(), constrained.end(), Ends(std::minmax(e.first, e.second)));
  });
}

}  // namespace

Mesh own_triangles(const Triangulation& mesh, const Pslg& pslg, const CellRefiner& cells, const Lattice& lattice,
                   Rank rank) {
  const auto owns = [&](TriangleId t) { return lattice.owner_of(cells.cell_of(t)) == rank; };
  Mesh piece = to_piece(mesh, pslg);
  std::size_t from = 0, kept = 0;  // to_piece keeps the order of triangles and of subsegments
  const bool regions = !piece.regions.empty();
  for (const TriangleId t : ids_of(mesh.triangles)) {
    if (!mesh.triangles[t].alive()) continue;
    if (owns(t)) {
      piece.triangles[kept] = piece.triangles[from];
      if (regions) piece.regions[kept] = piece.regions[from];
      ++kept;
    }
    ++from;
  }
  piece.triangles.resize(kept);
  if (regions) piece.regions.resize(kept);
  from = kept = 0;
  for (const Subsegment& s : mesh.subsegments) {
    if (!s.is_leaf()) continue;
    if (std::ranges::any_of(s.half, [&](HalfEdge h) { return h != kNone && owns(triangle_of(h)); }))
      piece.edges[kept++] = piece.edges[from];
    ++from;
  }
  piece.edges.resize(kept);
  std::size_t inputs = 0;
  for (const VertexId v : ids_of(mesh.points)) inputs += is_input(mesh.origin[v]) ? 1 : 0;
  piece.attributes.resize(inputs * piece.attributes_per_point);
  drop_unused_points(piece, inputs);
  return piece;
}

void keep_own_triangles(Triangulation& mesh, const CellRefiner& cells, const Lattice& lattice, Rank rank) {
  for (const TriangleId t : ids_of(mesh.triangles))
    if (mesh.triangles[t].alive() && lattice.owner_of(cells.cell_of(t)) != rank) mesh.remove_triangle(t);
}

OwnCounts count_own(const Triangulation& mesh, const Lattice& lattice, Rank rank) {
  const auto owns = [&](VertexId v) { return lattice.owner_of(lattice.cell_of(mesh.points[v])) == rank; };
  OwnCounts counts;
  for (const VertexId v : ids_of(mesh.points)) counts.vertices += mesh.origin[v] != kDeleted && owns(v) ? 1 : 0;
  for (const Subsegment& s : mesh.subsegments) counts.subsegments += s.is_leaf() && owns(s.vertex[0]) ? 1 : 0;
  return counts;
}

std::vector<Mail> GatherCells::send(int /*round*/) {
  if (rank_ == Rank{0}) return {};
  return {{Rank{0}, mesh_to_bytes(own_)}};
}

std::vector<Rank> GatherCells::senders(int /*round*/) const {
  std::vector<Rank> others;
  if (rank_ == Rank{0}) others = all_ranks(ranks_);
  std::erase(others, Rank{0});
  return others;
}

void GatherCells::receive(int /*round*/, std::vector<Mail> mail) {
  if (rank_ != Rank{0}) return;
  Joining joining(whole_);
  joining.add(own_);
  for (const Mail& one : mail) joining.add(mesh_of(one));
  joining.finish();
  whole_.names = own_.names;
  if (!fits_together(whole_)) throw Error("the cells of the ranks do not fit together");
  whole_.attributes_per_point = own_.attributes_per_point;
  whole_.attributes = std::move(own_.attributes);
  whole_.attributes.resize(whole_.points.size() * whole_.attributes_per_point, 0);
}

}  // namespace driftmesh::pdr
