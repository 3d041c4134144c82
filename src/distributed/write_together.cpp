#include "distributed/write_together.hpp"

#include <algorithm>
#include <utility>

#include "distributed/rank_status.hpp"
#include "io/msh_groups.hpp"

namespace driftmesh {
namespace {

constexpr Rank kMaker{0};  // creates the file

}  // namespace

VtuArrays arrays_of_pieces(const DistributedPiece& piece) {
  return {.point_markers = true,
          .attributes = piece.mesh.attributes_per_point,
          .numbers = true,
          .cell_markers = true,
          .regions = piece.has_regions,
          .subdomains = true,
          .ranks = true,
          .attribute_names = piece.mesh.attribute_names};
}

WriteTogether::WriteTogether(const DistributedPiece& piece, std::string path)
    : piece_(piece), path_(std::move(path)), part_{.mesh = piece.mesh, .points = {}, .lines = {}, .row = {}} {
  shape_.arrays = arrays_of_pieces(piece);
  shape_.names = piece.mesh.names;
  shape_.coordinates = piece.mesh.coordinates;
  part_.row.resize(piece.mesh.points.size());
  for (std::size_t v = 0; v < piece.owners.size(); ++v)
    if (piece.owners[v] == piece.rank) part_.points.push_back(static_cast<std::int32_t>(v));
}

std::vector<Mail> WriteTogether::send(int round) {
  switch (round) {
    case 0:
      return describe();
    case 1:
      return tell_rows();
    case 2:
      return piece_.rank == kMaker ? make_file() : std::vector<Mail>{};
    case 3:
      return status_to_all(piece_.ranks, [&] { write_hdf5_part(name_, path_, shape_, places_, part_); });
    default:
      return status_to_all(piece_.ranks, [&] {
        if (piece_.rank != kMaker) return;
        file_->commit();
        write_xdmf(path_, shape_);
      });
  }
}

std::vector<Rank> WriteTogether::senders(int round) const {
  if (round == 2) return {kMaker};
  return all_ranks(piece_.ranks);
}

void WriteTogether::receive(int round, std::vector<Mail> mail) {
  if (round == 0) return learn_counts(mail);
  if (round == 1) return learn_rows(mail);
  if (round == 2) return learn_places(mail.front());
  throw_first_failure(mail);
}

WriteTogether::Ends WriteTogether::ends_of(std::int32_t edge) const {
  const Mesh::Edge& e = piece_.mesh.edges[edge];
  const auto [low, high] = std::minmax(piece_.mesh.numbers[e.a], piece_.mesh.numbers[e.b]);
  return {low, high};
}

const DistributedPiece::Neighbor* WriteTogether::neighbor(Rank rank) const {
  const auto found = std::ranges::find(piece_.neighbors, rank, &DistributedPiece::Neighbor::rank);
  return found == piece_.neighbors.end() ? nullptr : &*found;
}

/// Those whose ends the other rank has, too: it may not have all of them.
std::vector<WriteTogether::Ends> WriteTogether::shared_edges(const DistributedPiece::Neighbor& with) const {
  std::vector<bool> is_shared(piece_.mesh.points.size(), false);
  for (const std::int32_t v : with.shared) is_shared[v] = true;
  std::vector<Ends> shared;
  for (std::size_t e = 0; e < piece_.mesh.edges.size(); ++e)
    if (is_shared[piece_.mesh.edges[e].a] && is_shared[piece_.mesh.edges[e].b])
      shared.push_back(ends_of(static_cast<std::int32_t>(e)));
  return shared;
}

std::vector<Mail> WriteTogether::describe() const {
  std::set<double> regions(piece_.mesh.regions.begin(), piece_.mesh.regions.end());
  std::vector<Mail> mail;
  for (const Rank to : all_ranks(piece_.ranks)) {
    const DistributedPiece::Neighbor* const after = piece_.rank < to ? neighbor(to) : nullptr;
    ByteWriter writer;
    writer.value(std::uint64_t{part_.points.size()});
    writer.value(std::uint64_t{piece_.mesh.triangles.size()});
    writer.array(std::vector<double>(regions.begin(), regions.end()));
    writer.array(after == nullptr ? std::vector<Ends>{} : shared_edges(*after));
    mail.push_back({to, writer.take()});
  }
  return mail;
}

void WriteTogether::learn_counts(const std::vector<Mail>& mail) {
  std::set<double> all_regions;
  std::set<Ends> written;  // by ranks before this one
  for (const Mail& from : mail) {
    std::uint64_t points = 0, triangles = 0;
    std::vector<double> regions;
    std::vector<Ends> edges;
    read_mail(from, [&](ByteReader& reader) {
      reader.value(points);
      reader.value(triangles);
      reader.array(regions);
      reader.array(edges);
    });
    if (from.rank < piece_.rank) part_.first_point += points, part_.first_triangle += triangles;
    shape_.points += points;
    shape_.triangles += triangles;
    all_regions.insert(regions.begin(), regions.end());
    written.insert(edges.begin(), edges.end());
  }
  part_.tags = tags_of_values(all_regions);
  for (std::size_t i = 0; i < part_.points.size(); ++i)
    part_.row[part_.points[i]] = static_cast<std::int64_t>(part_.first_point + i);
  for (std::size_t e = 0; e < piece_.mesh.edges.size(); ++e)
    if (!written.contains(ends_of(static_cast<std::int32_t>(e)))) part_.lines.push_back(static_cast<std::int32_t>(e));
}

std::vector<Mail> WriteTogether::tell_rows() const {
  std::vector<Mail> mail;
  for (const Rank to : all_ranks(piece_.ranks)) {
    std::vector<std::int64_t> rows;
    if (const DistributedPiece::Neighbor* const with = neighbor(to); with != nullptr)
      for (const std::int32_t v : with->shared)
        if (piece_.owners[v] == piece_.rank) rows.push_back(part_.row[v]);
    ByteWriter writer;
    writer.value(std::uint64_t{part_.lines.size()});
    writer.array(rows);
    mail.push_back({to, writer.take()});
  }
  return mail;
}

void WriteTogether::learn_rows(const std::vector<Mail>& mail) {
  for (const Mail& from : mail) {
    std::uint64_t lines = 0;
    std::vector<std::int64_t> rows;
    read_mail(from, [&](ByteReader& reader) {
      reader.value(lines);
      reader.array(rows);
    });
    if (from.rank < piece_.rank) part_.first_line += lines;
    shape_.lines += lines;
    const DistributedPiece::Neighbor* const with = neighbor(from.rank);
    if (with == nullptr) continue;
    auto next = rows.begin();
    for (const std::int32_t v : with->shared)
      if (piece_.owners[v] == from.rank && next != rows.end()) part_.row[v] = *next++;
  }
}

std::vector<Mail> WriteTogether::make_file() {
  ByteWriter writer;
  failure_in([&] {
    file_ = std::make_unique<AtomicFile>(path_);
    name_ = file_->name_meanwhile();
    places_ = create_hdf5(name_, path_, shape_);
  }).write(writer);
  writer.text(name_);
  writer.value(std::uint64_t{places_.size()});
  for (const auto& [array, place] : places_) {
    writer.text(array);
    writer.value(place);
  }
  std::vector<Mail> mail;
  for (const Rank to : all_ranks(piece_.ranks)) mail.push_back({to, writer.bytes()});
  return mail;
}

void WriteTogether::learn_places(const Mail& mail) {
  Failure failure;
  read_mail(mail, [&](ByteReader& reader) {
    failure = Failure::read(reader);
    name_ = reader.text();
    for (auto left = reader.value<std::uint64_t>(); left > 0; --left) {
      const std::string array = reader.text();
      reader.value(places_[array]);
    }
  });
  if (failure.kind != Failure::Kind::kNothing) raise(met_by(mail.rank, std::move(failure)));
}

}  // namespace driftmesh
