#include "distributed/piece_builder.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "base/narrow.hpp"
#include "driftmesh/error.hpp"
#include "mesh/interpolate_attributes.hpp"

namespace driftmesh {

using protocol::Rank;

namespace {

constexpr auto id = &Triangulation::id;

bool has_regions(const Decomposition& d) {
  return std::any_of(d.roots.begin(), d.roots.end(),
                     [](const auto& root) { return root.left_region != 0 || root.right_region != 0; });
}

}  // namespace

NumberedRoot* find_root(std::span<NumberedRoot> roots, RootId root) {
  const auto found = std::lower_bound(roots.begin(), roots.end(), root,
                                      [](const NumberedRoot& r, RootId wanted) { return r.root < wanted; });
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

DistributedPiece PieceBuilder::build(const HeldSubdomains& held, const Pslg& pslg) {
  piece_.rank = rank_;
  piece_.total_points = subdomains_.points;
  piece_.total_triangles = subdomains_.triangles;
  place_decomposition_points();
  place_added_points();
  reserve_triangles();
  held([&](SubdomainId i, const SubdomainMesh& part) { add_subdomain(i, part, pslg); });
  piece_.mesh.ranks.assign(piece_.mesh.triangles.size(), rank_);
  mark_points(pslg);
  set_attributes(pslg);
  find_sharers();
  return std::move(piece_);
}

void PieceBuilder::place_decomposition_points() {
  for (const SubdomainCensus& census : census_) {
    for (const RootId r : decomposition_.roots_of(census.id))
      for (const GlobalPointId v : {decomposition_.roots[id(r)].a, decomposition_.roots[id(r)].b})
        place_of_corner_[id(v)] = 0;
    for (const GlobalPointId v : decomposition_.inner_points_of(census.id)) place_of_corner_[id(v)] = 0;
  }
  for (std::size_t v = 0; v < place_of_corner_.size(); ++v) {
    if (place_of_corner_[v] == kNone) continue;
    place_of_corner_[v] = static_cast<std::int32_t>(corners_.size());
    corners_.push_back(static_cast<GlobalPointId>(v));
    piece_.mesh.numbers.push_back(static_cast<std::int64_t>(v));
    piece_.mesh.points.push_back(decomposition_.points[v]);
  }
  piece_.owners.assign(corners_.size(), rank_);
  is_placed_.assign(corners_.size(), true);
}

/// Points on roots and inner points in blocks of consecutive numbers, ascending.
void PieceBuilder::place_added_points() {
  struct Block {
    std::int64_t first_number;
    std::int64_t count;
    Rank owner;
    std::int32_t* place;
  };
  std::vector<Block> blocks;
  for (const NumberedRoot& r : roots_)
    blocks.push_back({r.first_number, static_cast<std::int64_t>(r.splits.count),
                      holder(owner_of(decomposition_.roots[id(r.root)])), &place_of_root_[id(r.root)]});
  for (std::size_t k = 0; k < census_.size(); ++k) {
    const SubdomainId i = census_[k].id;
    const std::int64_t on_roots = owned_points(decomposition_, census_[k]) - census_[k].free_points;
    blocks.push_back({subdomains_.first_number[id(i)] + on_roots, census_[k].free_points, rank_, &place_of_free_[k]});
  }
  std::sort(blocks.begin(), blocks.end(), [](const Block& a, const Block& b) {
    return std::pair(a.first_number, a.count) < std::pair(b.first_number, b.count);
  });
  std::int64_t added = 0;
  for (const Block& block : blocks) added += block.count;
  piece_.mesh.numbers.reserve(piece_.mesh.numbers.size() + static_cast<std::size_t>(added));
  for (const Block& block : blocks) {
    *block.place = narrow<std::int32_t>(piece_.mesh.numbers.size(), "vertices on one rank");
    for (std::int64_t k = 0; k < block.count; ++k) piece_.mesh.numbers.push_back(block.first_number + k);
    piece_.owners.resize(piece_.mesh.numbers.size(), block.owner);
  }
  (void)narrow<std::int32_t>(piece_.mesh.numbers.size(), "vertices on one rank");
  piece_.mesh.points.resize(piece_.mesh.numbers.size());
  piece_.mesh.point_markers.assign(piece_.mesh.numbers.size(), 0);
  is_placed_.resize(piece_.mesh.numbers.size(), false);
}

/// Growing arrays of this size step by step would touch twice the memory, which takes longer than filling them.
void PieceBuilder::reserve_triangles() {
  std::size_t triangles = 0;
  for (const SubdomainCensus& census : census_) triangles += static_cast<std::size_t>(census.triangles);
  piece_.mesh.triangles.reserve(triangles);
  piece_.mesh.subdomains.reserve(triangles);
  if (piece_.has_regions) piece_.mesh.regions.reserve(triangles);
}

void PieceBuilder::add_subdomain(SubdomainId i, const SubdomainMesh& part, const Pslg& pslg) {
  const std::vector<std::int32_t> place = place_vertices(i, part);
  add_triangles(i, part.mesh, place, pslg);
  add_edges(i, part, place);
}

/// Where each vertex of the subdomain's mesh is in the piece.
std::vector<std::int32_t> PieceBuilder::place_vertices(SubdomainId i, const SubdomainMesh& part) {
  const Triangulation& mesh = part.mesh;
  std::vector<std::int32_t> place(mesh.points.size(), kNone);
  for (std::size_t v = 0; v < part.points.size(); ++v) place[v] = place_of_corner_[id(part.points[v])];
  for (std::size_t r = 0; r < part.roots.size(); ++r) {
    std::int32_t next = place_of_root_[id(part.roots[r])];
    visit_splits(mesh, static_cast<RootId>(r), [&](dyadic::Path, VertexId v) { place[id(v)] = next++; });
  }
  const auto census = std::lower_bound(census_.begin(), census_.end(), i,
                                       [](const SubdomainCensus& c, SubdomainId wanted) { return c.id < wanted; });
  std::int32_t next_free = place_of_free_[static_cast<std::size_t>(census - census_.begin())];
  for (std::size_t v = 0; v < mesh.points.size(); ++v) {
    if (mesh.origin[v] == kFree) place[v] = next_free++;
    if (mesh.origin[v] != kDeleted) set_point(place[v], mesh.points[v], i);
  }
  return place;
}

void PieceBuilder::set_point(std::int32_t place, const Point& p, SubdomainId i) {
  const std::size_t v = id(place);
  Point& point = piece_.mesh.points[v];
  if (is_placed_[v] && !(point == p))
    throw Error("point " + std::to_string(piece_.mesh.numbers[v]) + " of the mesh has other coordinates in subdomain " +
                std::to_string(i) + " than in its neighbour on the same rank");
  point = p;
  is_placed_[v] = true;
}

void PieceBuilder::add_triangles(SubdomainId i, const Triangulation& mesh, const std::vector<std::int32_t>& place,
                                 const Pslg& pslg) {
  Mesh& piece = piece_.mesh;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (!mesh.triangles[t].alive()) continue;
    const auto& v = mesh.triangles[t].vertex;
    piece.triangles.push_back({place[id(v[0])], place[id(v[1])], place[id(v[2])]});
    if (!piece_.has_regions) continue;
    const std::size_t label = mesh.region.empty() ? 0 : mesh.region[t];
    piece.regions.push_back(label == 0 ? 0 : pslg.regions.at(label - 1).attribute);
  }
  (void)narrow<std::int32_t>(piece.triangles.size(), "triangles on one rank");
  piece.subdomains.resize(piece.triangles.size(), i);
}

/// The subsegments of the input. One between two subdomains of this rank is taken from the side that owns it.
void PieceBuilder::add_edges(SubdomainId i, const SubdomainMesh& part, const std::vector<std::int32_t>& place) {
  for (std::size_t r = 0; r < part.roots.size(); ++r) {
    const Decomposition::Root& root = decomposition_.roots[id(part.roots[r])];
    const SubdomainId owner = owner_of(root);
    if (root.separator || (owner != i && holder(owner) == rank_)) continue;
    std::int32_t from = place[id(part.mesh.roots[r].vertex[0])];
    const auto add = [&](VertexId to) {
      piece_.mesh.edges.push_back({from, place[id(to)], root.marker});
      from = place[id(to)];
    };
    visit_splits(part.mesh, static_cast<RootId>(r), [&](dyadic::Path, VertexId v) { add(v); });
    add(part.mesh.roots[r].vertex[1]);
  }
}

/// From the decomposition and the input, so that all ranks say the same: a point of the input keeps its marker, a point
/// on segments takes the first of theirs that is not 0.
void PieceBuilder::mark_points(const Pslg& pslg) {
  auto& markers = piece_.mesh.point_markers;
  for (const NumberedRoot& r : roots_)
    std::fill_n(markers.begin() + place_of_root_[id(r.root)], r.splits.count, decomposition_.roots[id(r.root)].marker);
  for (const Decomposition::Root& root : decomposition_.roots)
    for (const GlobalPointId v : {root.a, root.b})
      if (place_of_corner_[id(v)] != kNone && markers[id(place_of_corner_[id(v)])] == 0)
        markers[id(place_of_corner_[id(v)])] = root.marker;
  if (pslg.point_markers.empty()) return;
  for (std::size_t k = 0; k < corners_.size(); ++k) {
    const VertexOrigin origin = decomposition_.origin[id(corners_[k])];
    if (is_input(origin)) markers[k] = pslg.point_markers.at(id(origin));
  }
}

void PieceBuilder::set_attributes(const Pslg& pslg) {
  Mesh& piece = piece_.mesh;
  piece.attributes_per_point = pslg.attributes_per_point;
  if (pslg.attributes_per_point == 0 || piece.points.empty()) return;
  const auto width = id(pslg.attributes_per_point);
  const AttributeField field(pslg);
  piece.attributes.resize(piece.points.size() * width);
  for (std::size_t v = 0; v < piece.points.size(); ++v) {
    const std::span values = std::span(piece.attributes).subspan(v * width, width);
    const VertexOrigin origin = v < corners_.size() ? decomposition_.origin[id(corners_[v])] : kFree;
    if (is_input(origin))
      std::copy_n(pslg.attributes.begin() + static_cast<std::ptrdiff_t>(id(origin) * width), width, values.begin());
    else
      field.evaluate(piece.points[v], values);
  }
}

/// Who has which vertex follows from who holds which subdomain. A corner belongs to the rank of the lowest subdomain
/// at it.
void PieceBuilder::find_sharers() {
  std::vector<std::pair<Rank, std::int32_t>> shared;
  std::vector<SubdomainId> lowest(corners_.size(), INT32_MAX);
  for (const Decomposition::Root& root : decomposition_.roots)
    for (const GlobalPointId v : {root.a, root.b}) {
      const std::int32_t place = place_of_corner_[id(v)];
      if (place == kNone) continue;
      for (const SubdomainId side : {root.left, root.right}) {
        if (side == kNone) continue;
        lowest[id(place)] = std::min(lowest[id(place)], side);
        if (holder(side) != rank_) shared.emplace_back(holder(side), place);
      }
    }
  for (std::size_t k = 0; k < corners_.size(); ++k)
    if (lowest[k] != INT32_MAX) piece_.owners[k] = holder(lowest[k]);
  for (const NumberedRoot& r : roots_)
    for (const SubdomainId side : {decomposition_.roots[id(r.root)].left, decomposition_.roots[id(r.root)].right})
      if (side != kNone && holder(side) != rank_)
        for (std::int32_t k = 0; k < static_cast<std::int32_t>(r.splits.count); ++k)
          shared.emplace_back(holder(side), place_of_root_[id(r.root)] + k);
  std::sort(shared.begin(), shared.end());
  shared.erase(std::unique(shared.begin(), shared.end()), shared.end());
  for (const auto& [rank, place] : shared) {
    if (piece_.neighbors.empty() || piece_.neighbors.back().rank != rank) piece_.neighbors.push_back({rank, {}});
    piece_.neighbors.back().shared.push_back(place);
  }
}

}  // namespace driftmesh
