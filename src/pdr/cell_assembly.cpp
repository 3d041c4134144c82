#include "pdr/cell_assembly.hpp"

#include <algorithm>
#include <span>
#include <string>
#include <utility>

#include "base/mix.hpp"
#include "base/narrow.hpp"
#include "driftmesh/error.hpp"
#include "mesh/interpolate_attributes.hpp"
#include "pdr/own_cells.hpp"
#include "pdr/point_hash.hpp"

namespace driftmesh::pdr {
namespace {

std::uint64_t digest_of_edge(const Point& a, const Point& b) {
  const PointHash hash;
  const auto [low, high] = std::minmax({std::uint64_t{hash(a)}, std::uint64_t{hash(b)}});
  return mix(mix(low) + high);
}

}  // namespace

CellAssembly::CellAssembly(Rank rank, std::int32_t ranks, const Triangulation& mesh, const CellRefiner& cells,
                           const Lattice& lattice)
    : rank_(rank),
      ranks_(ranks),
      mesh_(mesh),
      cells_(cells),
      lattice_(lattice),
      owner_(mesh.points.size(), kNone),
      number_(mesh.points.size(), -1) {
  find_triangles();
  find_seams();
  own_.vertices = std::ranges::count(owner_, rank_);
  own_.triangles = static_cast<std::int64_t>(triangles_.size());
  own_.subsegments = count_own(mesh, lattice, rank).subsegments;
}

void CellAssembly::find_triangles() {
  for (const TriangleId t : ids_of(mesh_.triangles)) {
    if (!mesh_.triangles[t].alive() || lattice_.owner_of(cells_.cell_of(t)) != rank_) continue;
    triangles_.push_back(t);
    for (const VertexId v : mesh_.triangles[t].vertex) owner_[v] = rank_;
  }
}

/// Triangles at the border of the rank's cells are complete all around: it has followed what happened there.
void CellAssembly::find_seams() {
  for (const TriangleId t : ids_of(mesh_.triangles)) {
    if (!mesh_.triangles[t].alive()) continue;
    const auto& corners = mesh_.triangles[t].vertex;
    if (std::ranges::none_of(corners, [&](VertexId v) { return owner_[v] != kNone; })) continue;
    const Rank other = lattice_.owner_of(cells_.cell_of(t));
    if (other == rank_) continue;
    Seam& seam = seams_[other];
    for (const VertexId v : corners)
      if (owner_[v] != kNone) seam.vertices.push_back(v);
    for (int i = 0; i < 3; ++i) {
      const HalfEdge h = half_edge(t, i), across = mesh_.across(h);
      if (across != kNone && lattice_.owner_of(cells_.cell_of(triangle_of(across))) == rank_)
        seam.edges += digest_of_edge(mesh_.points[mesh_.edge_start(h)], mesh_.points[mesh_.edge_end(h)]);
    }
  }
  const auto place = [&](VertexId v) { return std::pair(mesh_.points[v].x, mesh_.points[v].y); };
  for (auto& [other, seam] : seams_) {
    std::ranges::sort(seam.vertices, {}, place);
    seam.vertices.erase(std::unique(seam.vertices.begin(), seam.vertices.end()), seam.vertices.end());
    for (const VertexId v : seam.vertices) owner_[v] = std::min(owner_[v], other);
  }
}

/// Of what both ranks of a seam should have alike.
std::uint64_t CellAssembly::digest_of(const Seam& seam) const {
  std::uint64_t digest = seam.edges;
  for (const VertexId v : seam.vertices) digest = mix(digest + kMixStep) ^ PointHash()(mesh_.points[v]);
  return digest;
}

// ---- The exchange ----

std::vector<Mail> CellAssembly::send(int round) {
  return round == 0 ? tell_counts() : tell_numbers();
}

std::vector<Rank> CellAssembly::senders(int round) const {
  if (round == 0) return all_ranks(ranks_);
  std::vector<Rank> others;
  for (const auto& [other, seam] : seams_) others.push_back(other);
  return others;
}

void CellAssembly::receive(int round, std::vector<Mail> mail) {
  if (round == 0) return learn_counts(mail);
  for (const Mail& one : mail) learn_numbers(one);
}

std::vector<Mail> CellAssembly::tell_counts() const {
  std::vector<Mail> mail;
  for (const Rank r : all_ranks(ranks_)) {
    ByteWriter writer;
    writer.value(own_);
    mail.push_back({r, writer.take()});
  }
  return mail;
}

void CellAssembly::learn_counts(const std::vector<Mail>& mail) {
  std::int64_t first = 0;
  for (const Mail& one : mail) {
    Counts counts;
    read_mail(one, [&](ByteReader& reader) { reader.value(counts); });
    if (one.rank < rank_) first += counts.vertices;
    total_.vertices += counts.vertices;
    total_.triangles += counts.triangles;
    total_.subsegments += counts.subsegments;
  }
  number_own_vertices(first);
}

void CellAssembly::number_own_vertices(std::int64_t first) {
  for (const VertexId v : ids_of(owner_))
    if (owner_[v] == rank_) number_[v] = first++;
}

std::vector<Mail> CellAssembly::tell_numbers() const {
  std::vector<Mail> mail;
  for (const auto& [other, seam] : seams_) {
    ByteWriter writer;
    writer.number(digest_of(seam));
    for (const VertexId v : seam.vertices)
      if (owner_[v] == rank_) writer.number(number_[v]);
    mail.push_back({other, writer.take()});
  }
  return mail;
}

void CellAssembly::learn_numbers(const Mail& mail) {
  const Seam& seam = seams_.at(mail.rank);
  read_mail(mail, [&](ByteReader& reader) {
    if (reader.number<std::uint64_t>() != digest_of(seam))
      throw Error("the cells of ranks " + std::to_string(to_int(std::min(mail.rank, rank_))) + " and " +
                  std::to_string(to_int(std::max(mail.rank, rank_))) + " do not fit together");
    for (const VertexId v : seam.vertices)
      if (owner_[v] == mail.rank) number_[v] = reader.number<std::int64_t>();
  });
}

// ---- The piece ----

DistributedPiece CellAssembly::piece(const Pslg& pslg) const {
  DistributedPiece piece;
  piece.rank = rank_;
  piece.ranks = ranks_;
  piece.has_regions = !mesh_.region.empty();
  piece.total_points = total_.vertices;
  piece.total_triangles = total_.triangles;
  piece.mesh.names = pslg.names;
  const std::vector<VertexId> vertices = vertices_by_number();
  Places place(mesh_.points.size(), -1);
  for (const VertexId v : vertices) {
    place[v] = static_cast<std::int32_t>(piece.mesh.points.size());
    piece.mesh.points.push_back(mesh_.points[v]);
    piece.mesh.numbers.push_back(number_[v]);
    piece.owners.push_back(owner_[v]);
  }
  add_triangles(place, pslg, piece.mesh);
  add_edges(place, piece.mesh);
  mark_points(vertices, pslg, piece.mesh);
  set_attributes(vertices, pslg, piece.mesh);
  for (const auto& [other, seam] : seams_) {
    DistributedPiece::Neighbor& neighbor = piece.neighbors.emplace_back(DistributedPiece::Neighbor{other, {}});
    for (const VertexId v : seam.vertices) neighbor.shared.push_back(place[v]);
    std::ranges::sort(neighbor.shared);
  }
  return piece;
}

void CellAssembly::add_triangles(const Places& place, const Pslg& pslg, Mesh& piece) const {
  for (const TriangleId t : triangles_) {
    const auto& v = mesh_.triangles[t].vertex;
    piece.triangles.push_back({place[v[0]], place[v[1]], place[v[2]]});
    if (mesh_.region.empty()) continue;
    const std::size_t label = mesh_.region[t];
    piece.regions.push_back(label == 0 ? 0 : pslg.regions.at(label - 1).attribute);
  }
  piece.subdomains.assign(piece.triangles.size(), 0);
  piece.ranks.assign(piece.triangles.size(), to_int(rank_));
}

/// Subsegments with a triangle here.
void CellAssembly::add_edges(const Places& place, Mesh& piece) const {
  const auto is_here = [&](HalfEdge h) {
    return h != kNone && lattice_.owner_of(cells_.cell_of(triangle_of(h))) == rank_;
  };
  for (const Subsegment& s : mesh_.subsegments)
    if (s.is_leaf() && std::ranges::any_of(s.half, is_here))
      piece.edges.push_back({place[s.vertex[0]], place[s.vertex[1]], mesh_.roots[s.root].marker});
}

std::vector<VertexId> CellAssembly::vertices_by_number() const {
  std::vector<VertexId> vertices;
  for (const VertexId v : ids_of(owner_))
    if (owner_[v] != kNone) vertices.push_back(v);
  (void)narrow<std::int32_t>(vertices.size(), "vertices on one rank");
  std::ranges::sort(vertices, {}, [&](VertexId v) { return number_[v]; });
  return vertices;
}

/// An input point keeps its marker; a point on segments gets their first nonzero marker. Ranks agree on which is the
/// first: points on several segments were there when all had the same subsegments.
void CellAssembly::mark_points(const std::vector<VertexId>& vertices, const Pslg& pslg, Mesh& piece) const {
  IdVector<VertexId, std::int32_t> markers(mesh_.points.size(), 0);
  for (const Subsegment& s : mesh_.subsegments)  // also those that have been split since
    for (const VertexId v : s.vertex)
      if (markers[v] == 0) markers[v] = mesh_.roots[s.root].marker;
  for (const VertexId v : vertices) {
    const VertexOrigin origin = mesh_.origin[v];
    const bool given = is_input(origin) && !pslg.point_markers.empty();
    piece.point_markers.push_back(given ? pslg.point_markers.at(origin) : markers[v]);
  }
}

void CellAssembly::set_attributes(const std::vector<VertexId>& vertices, const Pslg& pslg, Mesh& piece) const {
  const std::size_t width = pslg.attributes_per_point;
  piece.attributes_per_point = pslg.attributes_per_point;
  if (width == 0 || vertices.empty()) return;
  const AttributeField field(pslg);
  piece.attributes.resize(vertices.size() * width);
  for (std::size_t k = 0; k < vertices.size(); ++k)
    field.evaluate(mesh_.origin[vertices[k]], piece.points[k], std::span(piece.attributes).subspan(k * width, width));
}

}  // namespace driftmesh::pdr
