#include "distributed/ghost_layer.hpp"

#include <algorithm>
#include <numeric>
#include <set>
#include <span>
#include <string>

#include "base/narrow.hpp"
#include "distributed/mesh_bytes.hpp"
#include "driftmesh/id_vector.hpp"

namespace driftmesh {
namespace {

std::pair<std::int32_t, std::int32_t> ends_of(const Mesh::Edge& edge) {
  return std::minmax(edge.a, edge.b);
}

/// Copies point v of one mesh to the end of another, which has the same arrays.
void append_point(const Mesh& from, std::size_t v, Mesh& to) {
  to.points.push_back(from.points[v]);
  to.numbers.push_back(from.numbers[v]);
  if (!from.point_markers.empty()) to.point_markers.push_back(from.point_markers[v]);
  const std::size_t width = to_index(from.attributes_per_point);
  const auto values = std::span(from.attributes).subspan(v * width, width);
  to.attributes.insert(to.attributes.end(), values.begin(), values.end());
}

/// The same for triangle t, with corners of the other mesh.
void append_triangle(const Mesh& from, std::size_t t, const std::array<std::int32_t, 3>& corners, Mesh& to) {
  to.triangles.push_back(corners);
  to.subdomains.push_back(from.subdomains[t]);
  to.ranks.push_back(from.ranks[t]);
  if (!from.regions.empty()) to.regions.push_back(from.regions[t]);
}

bool is_consistent(const Mesh& mesh, std::size_t owners, std::size_t offsets) {
  const auto exists = [&](std::int32_t v) { return v >= 0 && to_index(v) < mesh.points.size(); };
  return std::ranges::all_of(mesh.triangles, [&](const auto& t) { return std::ranges::all_of(t, exists); }) &&
         std::ranges::all_of(mesh.edges, [&](const auto& e) { return exists(e.a) && exists(e.b); }) &&
         mesh.numbers.size() == mesh.points.size() && owners == mesh.points.size() &&
         offsets == mesh.triangles.size() && mesh.subdomains.size() == offsets && mesh.ranks.size() == offsets;
}

}  // namespace

std::vector<Mail> GhostLayer::send(int /*round*/) {
  std::vector<Mail> mail;
  for (const DistributedPiece::Neighbor& neighbor : piece_.neighbors)
    sent_[neighbor.rank] = triangles_at(neighbor.shared);
  for (const Rank to : all_ranks(piece_.ranks)) {
    const auto sent = sent_.find(to);
    const Part part = part_of(sent == sent_.end() ? std::vector<std::int32_t>{} : sent->second);
    ByteWriter writer;
    writer.array(own_blocks());
    writer.array(part.owners);
    writer.array(part.offsets);
    writer.array(mesh_to_bytes(part.mesh));
    mail.push_back({to, writer.take()});
  }
  return mail;
}

std::vector<Rank> GhostLayer::senders(int /*round*/) const {
  return all_ranks(piece_.ranks);
}

void GhostLayer::receive(int /*round*/, std::vector<Mail> mail) {
  const std::vector<Part> parts = read(mail);
  number_subdomains();
  begin_with_piece();
  add_points(parts);
  add_triangles(parts);
  add_edges(parts);
}

/// Triangles are sorted by subdomain.
std::vector<GhostLayer::Block> GhostLayer::own_blocks() const {
  std::vector<Block> blocks;
  for (const std::int32_t subdomain : piece_.mesh.subdomains) {
    if (blocks.empty() || blocks.back().subdomain != subdomain) blocks.push_back({subdomain, 0});
    ++blocks.back().triangles;
  }
  return blocks;
}

std::vector<std::int32_t> GhostLayer::triangles_at(const std::vector<std::int32_t>& points) const {
  std::vector<bool> is_shared(piece_.mesh.points.size(), false);
  for (const std::int32_t v : points) is_shared[to_index(v)] = true;
  std::vector<std::int32_t> found;
  for (std::size_t t = 0; t < piece_.mesh.triangles.size(); ++t)
    if (std::ranges::any_of(piece_.mesh.triangles[t], [&](std::int32_t v) { return is_shared[to_index(v)]; }))
      found.push_back(static_cast<std::int32_t>(t));
  return found;
}

/// With the subsegments whose ends are points of these triangles: one that is a side of another triangle does no harm.
GhostLayer::Part GhostLayer::part_of(const std::vector<std::int32_t>& triangles) const {
  const Mesh& mesh = piece_.mesh;
  Part part{.rank = piece_.rank, .mesh = {}, .owners = {}, .offsets = {}};
  part.mesh.attributes_per_point = mesh.attributes_per_point;
  std::map<std::int32_t, std::int32_t> place;
  const auto placed = [&](std::int32_t v) {
    const auto [known, is_new] = place.try_emplace(v, static_cast<std::int32_t>(part.mesh.points.size()));
    if (is_new) {
      append_point(mesh, to_index(v), part.mesh);
      part.owners.push_back(piece_.owners[to_index(v)]);
    }
    return known->second;
  };
  for (const std::int32_t t : triangles) {
    const auto& [a, b, c] = mesh.triangles[to_index(t)];
    append_triangle(mesh, to_index(t), {placed(a), placed(b), placed(c)}, part.mesh);
    const auto first = std::ranges::lower_bound(mesh.subdomains, mesh.subdomains[to_index(t)]);
    part.offsets.push_back(t - (first - mesh.subdomains.begin()));
  }
  for (const Mesh::Edge& edge : mesh.edges)
    if (const auto a = place.find(edge.a), b = place.find(edge.b); a != place.end() && b != place.end())
      part.mesh.edges.push_back({a->second, b->second, edge.marker});
  return part;
}

std::vector<GhostLayer::Part> GhostLayer::read(const std::vector<Mail>& mail) {
  std::vector<Part> parts;
  for (const Mail& from : mail) {
    Part part{.rank = from.rank, .mesh = {}, .owners = {}, .offsets = {}};
    std::vector<Block> blocks;
    Bytes mesh;
    read_mail(from, [&](ByteReader& reader) {
      reader.array(blocks);
      reader.array(part.owners);
      reader.array(part.offsets);
      reader.array(mesh);
    });
    part.mesh = mesh_of({from.rank, std::move(mesh)});
    protocol::read_from(from.rank, [&] {
      if (!is_consistent(part.mesh, part.owners.size(), part.offsets.size()))
        throw Error("its triangles have no points");
      learn_blocks(from.rank, blocks);
    });
    if (from.rank != piece_.rank) parts.push_back(std::move(part));
  }
  return parts;
}

void GhostLayer::learn_blocks(Rank from, const std::vector<Block>& blocks) {
  for (const Block& block : blocks)
    if (!first_.try_emplace(block.subdomain, block.triangles).second)
      throw Error("rank " + to_string(from) + " has subdomain " + std::to_string(block.subdomain) +
                  ", and so has another one");
}

void GhostLayer::number_subdomains() {
  std::int64_t next = 0;
  for (auto& [subdomain, triangles] : first_) next += std::exchange(triangles, next);
}

void GhostLayer::begin_with_piece() {
  result_.rank = piece_.rank;
  result_.ranks = piece_.ranks;
  result_.mesh = piece_.mesh;
  result_.owners = piece_.owners;
  result_.own_points = static_cast<std::int32_t>(piece_.mesh.points.size());
  result_.own_triangles = static_cast<std::int32_t>(piece_.mesh.triangles.size());
  result_.own_edges = static_cast<std::int32_t>(piece_.mesh.edges.size());
  for (const Block& block : own_blocks())
    for (std::int64_t k = 0; k < block.triangles; ++k)
      result_.triangle_numbers.push_back(first_.at(block.subdomain) + k);
}

/// Those that the piece has not, by number. Several neighbors may send one.
void GhostLayer::add_points(const std::vector<Part>& parts) {
  struct SentPoint {
    const Part* part = nullptr;
    std::size_t point = 0;
  };
  std::map<std::int64_t, SentPoint> added;
  for (const Part& part : parts)
    for (std::size_t v = 0; v < part.mesh.points.size(); ++v)
      if (!std::ranges::binary_search(piece_.mesh.numbers, part.mesh.numbers[v]))
        added.try_emplace(part.mesh.numbers[v], SentPoint{&part, v});
  for (const auto& [number, source] : added) {
    append_point(source.part->mesh, source.point, result_.mesh);
    result_.owners.push_back(source.part->owners[source.point]);
  }
  (void)narrow<std::int32_t>(result_.mesh.points.size(), "vertices on one rank");
}

/// Numbers of points ascend within the piece and within its ghosts.
std::int32_t GhostLayer::place_of(std::int64_t number) const {
  const auto& numbers = result_.mesh.numbers;
  const auto ghosts = numbers.begin() + result_.own_points;
  const auto own = std::lower_bound(numbers.begin(), ghosts, number);
  const auto found = own != ghosts && *own == number ? own : std::lower_bound(ghosts, numbers.end(), number);
  return static_cast<std::int32_t>(found - numbers.begin());
}

void GhostLayer::add_triangles(const std::vector<Part>& parts) {
  struct SentTriangle {
    const Part* part = nullptr;
    std::size_t triangle = 0;
    std::int32_t place = 0;  // in the result
  };
  std::map<std::int64_t, SentTriangle> added;
  for (const Part& part : parts)
    for (std::size_t t = 0; t < part.mesh.triangles.size(); ++t)
      added.try_emplace(first_.at(part.mesh.subdomains[t]) + part.offsets[t], SentTriangle{&part, t});
  for (auto& [number, source] : added) {
    const Mesh& mesh = source.part->mesh;
    std::array<std::int32_t, 3> corners = mesh.triangles[source.triangle];
    for (std::int32_t& corner : corners) corner = place_of(mesh.numbers[to_index(corner)]);
    source.place = narrow<std::int32_t>(result_.mesh.triangles.size(), "triangles on one rank");
    append_triangle(mesh, source.triangle, corners, result_.mesh);
    result_.triangle_numbers.push_back(number);
  }
  for (const Part& part : parts) {
    if (part.mesh.triangles.empty()) continue;
    GhostedPiece::Neighbor neighbor{part.rank, std::move(sent_[part.rank]), {}};
    for (std::size_t t = 0; t < part.mesh.triangles.size(); ++t)
      neighbor.received.push_back(added.at(first_.at(part.mesh.subdomains[t]) + part.offsets[t]).place);
    result_.neighbors.push_back(std::move(neighbor));
  }
}

/// Subsegments that are sides of ghosts. Those between two ranks are known to both.
void GhostLayer::add_edges(const std::vector<Part>& parts) {
  std::set<std::pair<std::int32_t, std::int32_t>> sides, known;
  for (std::size_t t = to_index(result_.own_triangles); t < result_.mesh.triangles.size(); ++t)
    for (std::size_t i = 0; i < 3; ++i)
      sides.insert(std::minmax(result_.mesh.triangles[t][i], result_.mesh.triangles[t][(i + 1) % 3]));
  for (const Mesh::Edge& edge : piece_.mesh.edges) known.insert(ends_of(edge));
  for (const Part& part : parts)
    for (Mesh::Edge edge : part.mesh.edges) {
      edge.a = place_of(part.mesh.numbers[to_index(edge.a)]);
      edge.b = place_of(part.mesh.numbers[to_index(edge.b)]);
      if (sides.contains(ends_of(edge)) && known.insert(ends_of(edge)).second) result_.mesh.edges.push_back(edge);
    }
}

}  // namespace driftmesh
