#include "distributed/piece_builder.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "base/narrow.hpp"
#include "driftmesh/error.hpp"
#include "mesh/interpolate_attributes.hpp"

namespace driftmesh {

namespace {

bool has_regions(const Decomposition& d) {
  return std::any_of(d.roots.begin(), d.roots.end(),
                     [](const auto& root) { return root.left_region != 0 || root.right_region != 0; });
}

}  // namespace

NumberedRoot* find_root(std::span<NumberedRoot> roots, GlobalRootId root) {
  const auto found = std::lower_bound(roots.begin(), roots.end(), root,
                                      [](const NumberedRoot& r, GlobalRootId wanted) { return r.root < wanted; });
  return found != roots.end() && found->root == root ? &*found : nullptr;
}

PieceBuilder::PieceBuilder(Rank rank, const Decomposition& decomposition, const SubdomainTable& subdomains,
                           std::span<const NumberedRoot> roots, std::span<const SubdomainCensus> census)
    : rank_(rank),
      decomposition_(decomposition),
      subdomains_(subdomains),
      roots_(roots),
      census_(census),
      place_of_corner_(decomposition.points.size(), kNone),
      place_of_root_(decomposition.roots.size(), kNone),
      place_of_free_(census.size(), kNone) {
  piece_.has_regions = has_regions(decomposition);
}

DistributedPiece PieceBuilder::build(const HeldSubdomains& held, const Pslg& pslg, PiecePlaces* places) {
  piece_.rank = rank_;
  piece_.total_points = subdomains_.points;
  piece_.total_triangles = subdomains_.triangles;
  place_decomposition_points();
  place_added_points();
  reserve_triangles();
  held([&](SubdomainId i, const SubdomainMesh& part) {
    IdVector<VertexId, Place> place = add_subdomain(i, part, pslg);
    if (places != nullptr) (*places)[i] = std::move(place);
  });
  piece_.mesh.ranks.assign(piece_.mesh.triangles.size(), to_int(rank_));
  mark_points(pslg);
  set_attributes(pslg);
  piece_.mesh.names = pslg.names;
  find_sharers();
  return std::move(piece_);
}

void PieceBuilder::place_decomposition_points() {
  for (const SubdomainCensus& census : census_) {
    for (const GlobalRootId r : decomposition_.roots_of(census.id))
      for (const GlobalPointId v : {decomposition_.roots[r].a, decomposition_.roots[r].b}) place_of_corner_[v] = 0;
    for (const GlobalPointId v : decomposition_.inner_points_of(census.id)) place_of_corner_[v] = 0;
  }
  for (const GlobalPointId v : ids_of(place_of_corner_)) {
    if (place_of_corner_[v] == kNone) continue;
    place_of_corner_[v] = corners_.next_id();
    corners_.push_back(v);
    piece_.mesh.numbers.push_back(to_int(v));
    piece_.mesh.points.push_back(decomposition_.points[v]);
  }
  piece_.owners.assign(corners_.size(), rank_);
  is_placed_.assign(corners_.size(), true);
}

/// Points on roots and inner points, in blocks of consecutive numbers, ascending.
void PieceBuilder::place_added_points() {
  struct Block {
    std::int64_t first_number;
    std::int64_t count;
    Rank owner;
    Place* place;
  };
  std::vector<Block> blocks;
  for (const NumberedRoot& r : roots_)
    blocks.push_back({r.first_number, static_cast<std::int64_t>(r.splits.count),
                      holder(owner_of(decomposition_.roots[r.root])), &place_of_root_[r.root]});
  for (std::size_t k = 0; k < census_.size(); ++k) {
    const SubdomainId i = census_[k].id;
    const std::int64_t on_roots = owned_points(decomposition_, census_[k]) - census_[k].free_points;
    blocks.push_back({subdomains_.first_number[i] + on_roots, census_[k].free_points, rank_, &place_of_free_[k]});
  }
  std::sort(blocks.begin(), blocks.end(), [](const Block& a, const Block& b) {
    return std::pair(a.first_number, a.count) < std::pair(b.first_number, b.count);
  });
  std::int64_t added = 0;
  for (const Block& block : blocks) added += block.count;
  piece_.mesh.numbers.reserve(piece_.mesh.numbers.size() + to_index(added));
  for (const Block& block : blocks) {
    *block.place = narrow<Place>(piece_.mesh.numbers.size(), "vertices on one rank");
    for (std::int64_t k = 0; k < block.count; ++k) piece_.mesh.numbers.push_back(block.first_number + k);
    piece_.owners.resize(piece_.mesh.numbers.size(), block.owner);
  }
  (void)narrow<Place>(piece_.mesh.numbers.size(), "vertices on one rank");
  piece_.mesh.points.resize(piece_.mesh.numbers.size());
  piece_.mesh.point_markers.assign(piece_.mesh.numbers.size(), 0);
  is_placed_.resize(piece_.mesh.numbers.size(), false);
}

/// Growing such large arrays step by step would touch twice the memory, which takes more time than filling them.
void PieceBuilder::reserve_triangles() {
  std::size_t triangles = 0;
  for (const SubdomainCensus& census : census_) triangles += to_index(census.triangles);
  piece_.mesh.triangles.reserve(triangles);
  piece_.mesh.subdomains.reserve(triangles);
  if (piece_.has_regions) piece_.mesh.regions.reserve(triangles);
}

/// Returns the places of its vertices.
IdVector<VertexId, PieceBuilder::Place> PieceBuilder::add_subdomain(SubdomainId i, const SubdomainMesh& part,
                                                                    const Pslg& pslg) {
  IdVector<VertexId, Place> place = place_vertices(i, part);
  add_triangles(i, part.mesh, place, pslg);
  add_edges(i, part, place);
  return place;
}

/// The place in the piece of each vertex of the subdomain's mesh.
IdVector<VertexId, PieceBuilder::Place> PieceBuilder::place_vertices(SubdomainId i, const SubdomainMesh& part) {
  const Triangulation& mesh = part.mesh;
  IdVector<VertexId, Place> place(mesh.points.size(), kNone);
  for (const VertexId v : ids_of(part.points)) place[v] = place_of_corner_[part.points[v]];
  for (const RootId r : ids_of(part.roots)) {
    Place next = place_of_root_[part.roots[r]];
    visit_splits(mesh, r, [&](dyadic::Path, VertexId v) { place[v] = next++; });
  }
  const auto census = std::lower_bound(census_.begin(), census_.end(), i,
                                       [](const SubdomainCensus& c, SubdomainId wanted) { return c.id < wanted; });
  Place next_free = place_of_free_[to_index(census - census_.begin())];
  for (const VertexId v : ids_of(place)) {
    if (mesh.origin[v] == kFree) place[v] = next_free++;
    if (mesh.origin[v] != kDeleted) set_point(place[v], mesh.points[v], i);
  }
  return place;
}

void PieceBuilder::set_point(Place place, const Point& p, SubdomainId i) {
  Point& point = piece_.mesh.points[place];
  if (is_placed_[place] && !(point == p))
    throw Error("point " + std::to_string(piece_.mesh.numbers[place]) +
                " of the mesh has different coordinates in subdomain " + to_string(i) +
                " and in its neighbor on the same rank");
  point = p;
  is_placed_[place] = true;
}

void PieceBuilder::add_triangles(SubdomainId i, const Triangulation& mesh, const IdVector<VertexId, Place>& place,
                                 const Pslg& pslg) {
  Mesh& piece = piece_.mesh;
  for (const TriangleId t : ids_of(mesh.triangles)) {
    if (!mesh.triangles[t].alive()) continue;
    const auto& v = mesh.triangles[t].vertex;
    piece.triangles.push_back({place[v[0]], place[v[1]], place[v[2]]});
    if (!piece_.has_regions) continue;
    const std::size_t label = mesh.region.empty() ? 0 : mesh.region[t];
    piece.regions.push_back(label == 0 ? 0 : pslg.regions.at(label - 1).attribute);
  }
  (void)narrow<std::int32_t>(piece.triangles.size(), "triangles on one rank");
  piece.subdomains.resize(piece.triangles.size(), to_int(i));
}

/// The subsegments of the input. A subsegment between two subdomains of this rank is taken from the side that owns it.
void PieceBuilder::add_edges(SubdomainId i, const SubdomainMesh& part, const IdVector<VertexId, Place>& place) {
  for (const RootId r : ids_of(part.roots)) {
    const Decomposition::Root& root = decomposition_.roots[part.roots[r]];
    const SubdomainId owner = owner_of(root);
    if (root.separator || (owner != i && holder(owner) == rank_)) continue;
    const auto& ends = part.mesh.roots[r].vertex;
    Place from = place[ends[0]];
    const auto add = [&](VertexId to) {
      piece_.mesh.edges.push_back({from, place[to], root.marker});
      from = place[to];
    };
    visit_splits(part.mesh, r, [&](dyadic::Path, VertexId v) { add(v); });
    add(ends[1]);
  }
}

/// Markers follow from the decomposition and the input, so all ranks agree: an input point keeps its marker; a point on
/// segments gets their first nonzero marker.
void PieceBuilder::mark_points(const Pslg& pslg) {
  auto& markers = piece_.mesh.point_markers;
  for (const NumberedRoot& r : roots_)
    std::fill_n(markers.begin() + place_of_root_[r.root], r.splits.count, decomposition_.roots[r.root].marker);
  for (const Decomposition::Root& root : decomposition_.roots)
    for (const GlobalPointId v : {root.a, root.b})
      if (const Place place = place_of_corner_[v]; place != kNone && markers[place] == 0) markers[place] = root.marker;
  if (pslg.point_markers.empty()) return;
  for (const Place k : ids_of(corners_)) {
    const VertexOrigin origin = decomposition_.origin[corners_[k]];
    if (is_input(origin)) markers[k] = pslg.point_markers.at(origin);
  }
}

void PieceBuilder::set_attributes(const Pslg& pslg) {
  Mesh& piece = piece_.mesh;
  piece.attributes_per_point = pslg.attributes_per_point;
  if (pslg.attributes_per_point == 0 || piece.points.empty()) return;
  const std::size_t width = pslg.attributes_per_point;
  const AttributeField field(pslg);
  piece.attributes.resize(piece.points.size() * width);
  for (std::size_t v = 0; v < piece.points.size(); ++v) {
    const auto place = static_cast<Place>(v);
    const VertexOrigin origin = corners_.has(place) ? decomposition_.origin[corners_[place]] : kFree;
    field.evaluate(origin, piece.points[v], std::span(piece.attributes).subspan(v * width, width));
  }
}

/// Which ranks have a vertex follows from which subdomains they hold. A corner belongs to the rank of the lowest
/// subdomain at it.
void PieceBuilder::find_sharers() {
  std::vector<std::pair<Rank, Place>> shared;
  IdVector<Place, SubdomainId> lowest(corners_.size(), kNoSubdomain);
  for (const Decomposition::Root& root : decomposition_.roots)
    for (const GlobalPointId v : {root.a, root.b}) {
      const Place place = place_of_corner_[v];
      if (place == kNone) continue;
      for (const SubdomainId side : {root.left, root.right}) {
        if (side == kNoSubdomain) continue;
        lowest[place] = lowest[place] == kNoSubdomain ? side : std::min(lowest[place], side);
        if (holder(side) != rank_) shared.emplace_back(holder(side), place);
      }
    }
  for (const Place k : ids_of(lowest))
    if (lowest[k] != kNoSubdomain) piece_.owners[k] = holder(lowest[k]);
  for (const NumberedRoot& r : roots_)
    for (const SubdomainId side : {decomposition_.roots[r.root].left, decomposition_.roots[r.root].right})
      if (side != kNoSubdomain && holder(side) != rank_)
        for (Place k = 0; k < static_cast<Place>(r.splits.count); ++k)
          shared.emplace_back(holder(side), place_of_root_[r.root] + k);
  std::sort(shared.begin(), shared.end());
  shared.erase(std::unique(shared.begin(), shared.end()), shared.end());
  for (const auto& [rank, place] : shared) {
    if (piece_.neighbors.empty() || piece_.neighbors.back().rank != rank) piece_.neighbors.push_back({rank, {}});
    piece_.neighbors.back().shared.push_back(place);
  }
}

}  // namespace driftmesh
