#include "distributed/write_distributed.hpp"

#include <functional>
#include <numeric>
#include <utility>

#include "base/error.hpp"
#include "distributed/wire.hpp"
#include "mesh/merge_pieces.hpp"
#include "output/pvtu_format.hpp"

namespace driftmesh {

using protocol::Bytes;
using protocol::Rank;

namespace {

Bytes pack(const MeshPiece& mesh) {
  WireWriter writer;
  writer.array(mesh.points);
  writer.array(mesh.triangles);
  writer.array(mesh.edges);
  writer.array(mesh.point_markers);
  writer.array(mesh.attributes);
  writer.value(mesh.attributes_per_point);
  writer.array(mesh.regions);
  writer.array(mesh.numbers);
  writer.array(mesh.subdomains);
  writer.array(mesh.ranks);
  return writer.take();
}

MeshPiece unpack(const Mail& mail) {
  WireReader reader(mail.rank, mail.bytes);
  MeshPiece mesh;
  mesh.points = reader.array<Point>();
  mesh.triangles = reader.array<std::array<std::int32_t, 3>>();
  mesh.edges = reader.array<MeshPiece::Edge>();
  mesh.point_markers = reader.array<std::int32_t>();
  mesh.attributes = reader.array<double>();
  mesh.attributes_per_point = reader.value<std::int32_t>();
  mesh.regions = reader.array<double>();
  mesh.numbers = reader.array<std::int64_t>();
  mesh.subdomains = reader.array<std::int32_t>();
  mesh.ranks = reader.array<std::int32_t>();
  reader.finish();
  return mesh;
}

std::vector<Rank> all_of(Rank ranks) {
  std::vector<Rank> all(static_cast<std::size_t>(ranks));
  std::iota(all.begin(), all.end(), 0);
  return all;
}

/// What became of a rank's work, for all to know: empty if it went well, else the error.
std::vector<Mail> status_to_all(Rank ranks, const std::function<void()>& work) {
  std::string status;
  try {
    work();
  } catch (const std::exception& error) {
    status = error.what();
    if (status.empty()) status = "failed";
  }
  const auto* const first = reinterpret_cast<const std::byte*>(status.data());
  std::vector<Mail> mail;
  for (Rank to = 0; to < ranks; ++to) mail.push_back({to, Bytes(first, first + status.size())});
  return mail;
}

void throw_first_failure(const std::vector<Mail>& statuses) {
  for (const Mail& mail : statuses) {
    if (mail.bytes.empty()) continue;
    std::string what = "rank " + std::to_string(mail.rank) + ": ";
    for (const std::byte b : mail.bytes) what += static_cast<char>(b);
    throw Error(what);
  }
}

/// Of every piece alike, whatever this one happens to hold.
VtuArrays arrays_of_pieces(const DistributedPiece& piece) {
  return {true, piece.mesh.attributes_per_point, true, true, piece.has_regions, true, true};
}

}  // namespace

std::vector<Mail> GatherPieces::send(int) {
  std::vector<Mail> mail;
  mail.push_back({0, pack(piece_.mesh)});
  return mail;
}

std::vector<Rank> GatherPieces::senders(int) const {
  return piece_.rank == 0 ? all_of(piece_.ranks) : std::vector<Rank>();
}

void GatherPieces::receive(int, std::vector<Mail> mail) {
  if (piece_.rank != 0) return;
  std::vector<MeshPiece> pieces;
  for (Mail& message : mail) {
    pieces.push_back(unpack(message));
    message.bytes = {};
  }
  MergeFaults faults;
  whole_ = merge_pieces(pieces, faults);
  if (faults.count != 0) throw Error("the pieces of the mesh do not fit together: " + faults.first[0]);
}

WritePieces::WritePieces(const DistributedPiece& piece, std::string path) : piece_(piece), path_(std::move(path)) {}

std::vector<Mail> WritePieces::send(int round) {
  return status_to_all(piece_.ranks, [&] { write_or_commit(round); });
}

void WritePieces::write_or_commit(int round) {
  if (round == 0) file_ = prepare_vtu(piece_.mesh, arrays_of_pieces(piece_), pvtu_piece_path(path_, piece_.rank));
  if (round == 1) file_->commit();
  if (round == 2 && piece_.rank == 0) write_pvtu(path_, piece_.ranks, arrays_of_pieces(piece_));
}

std::vector<Rank> WritePieces::senders(int) const {
  return all_of(piece_.ranks);
}

void WritePieces::receive(int, std::vector<Mail> mail) {
  throw_first_failure(mail);
}

WriteWhole::WriteWhole(const DistributedPiece& piece, const MeshPiece& whole, std::string path, WriteOptions options)
    : piece_(piece), whole_(whole), path_(std::move(path)), options_(std::move(options)) {}

std::vector<Mail> WriteWhole::send(int) {
  if (piece_.rank != 0) return {};
  return status_to_all(piece_.ranks, [&] { write_mesh(whole_, path_, options_); });
}

std::vector<Rank> WriteWhole::senders(int) const {
  return {0};
}

void WriteWhole::receive(int, std::vector<Mail> mail) {
  throw_first_failure(mail);
}

void write_distributed(ExchangeRunner& ranks, const DistributedPiece& piece, const std::string& path,
                       const WriteOptions& options) {
  if (is_in_pieces(path)) {
    WritePieces pieces(piece, path);
    return ranks.run(pieces);
  }
  GatherPieces gather(piece);
  ranks.run(gather);
  WriteWhole whole(piece, gather.whole(), path, options);
  ranks.run(whole);
}

}  // namespace driftmesh
