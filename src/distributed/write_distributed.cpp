#include "distributed/write_distributed.hpp"

#include <algorithm>
#include <functional>
#include <iterator>
#include <optional>
#include <string_view>
#include <utility>

#include "base/bytes.hpp"
#include "base/in_parts.hpp"
#include "base/staged_files.hpp"
#include "distributed/ghost_layer.hpp"
#include "distributed/mesh_bytes.hpp"
#include "distributed/rank_status.hpp"
#include "distributed/write_mfem.hpp"
#include "distributed/write_together.hpp"
#include "io/other_coordinates.hpp"
#include "io/pvtu_format.hpp"
#include "mesh/merge_pieces.hpp"

namespace driftmesh {

namespace {

constexpr Rank kWriter{0};  // writes files of the whole mesh

VtuArrays arrays_of_series(const DistributedPiece& piece, bool ghost_layer) {
  VtuArrays arrays = arrays_of_pieces(piece);
  arrays.ghosts = piece.ranks > 1;
  arrays.ghost_cells = ghost_layer && piece.ranks > 1;
  return arrays;
}

/// A point that several pieces have is a duplicate in all but that of its owner.
VtuGhosts ghosts_of(Rank rank, const std::vector<Rank>& owners) {
  VtuGhosts ghosts{.rank = to_int(rank)};
  for (const Rank owner : owners) ghosts.points.push_back(owner == rank ? 0 : kDuplicate);
  return ghosts;
}

/// `ghosted`: the same with its ghosts, or null.
std::unique_ptr<FileSink> prepare_piece(const DistributedPiece& piece, const GhostedPiece* ghosted,
                                        const std::string& path) {
  const VtuArrays arrays = arrays_of_series(piece, ghosted != nullptr);
  const std::string name = pvtu_piece_path(path, to_int(piece.rank));
  if (piece.ranks == 1) return prepare_vtu(piece.mesh, arrays, name);
  if (ghosted == nullptr) return prepare_vtu(piece.mesh, arrays, name, ghosts_of(piece.rank, piece.owners));
  return prepare_vtu(ghosted->mesh, arrays, name, ghosts_of(piece.rank, ghosted->owners));
}

}  // namespace

std::vector<Mail> GatherPieces::send(int round) {
  std::vector<Mail> mail;
  if (round == 0 && piece_.rank != kWriter) mail.push_back({kWriter, mesh_to_bytes(piece_.mesh)});
  if (round == 1 && piece_.rank == kWriter) mail = status_to_all(piece_.ranks, [&] { merge(); });
  return mail;
}

std::vector<Rank> GatherPieces::senders(int round) const {
  if (round == 1) return {kWriter};
  if (piece_.rank != kWriter) return {};
  std::vector<Rank> others = all_ranks(piece_.ranks);
  std::erase(others, kWriter);
  return others;
}

void GatherPieces::receive(int round, std::vector<Mail> mail) {
  if (round == 0)
    pieces_ = std::move(mail);
  else
    throw_first_failure(mail);
}

void GatherPieces::merge() {
  std::vector<Mesh> others;
  for (Mail& mail : pieces_) {
    others.push_back(mesh_of(mail));
    mail.bytes = {};
  }
  std::vector<const Mesh*> pieces{&piece_.mesh};
  for (const Mesh& piece : others) pieces.push_back(&piece);
  MergeFaults faults;
  whole_ = merge_pieces(pieces, faults);
  if (faults.count != 0) throw Error("the pieces of the mesh do not fit together: " + faults.first[0]);
}

WritePieces::WritePieces(const DistributedPiece& piece, std::string path, const GhostedPiece* ghosted)
    : piece_(piece), ghosted_(ghosted), path_(std::move(path)) {}

std::vector<Mail> WritePieces::send(int round) {
  return status_to_all(piece_.ranks, [&] { write_or_commit(round); });
}

void WritePieces::write_or_commit(int round) {
  if (round == 0) file_ = prepare_piece(piece_, ghosted_, path_);
  if (round == 1) file_->commit();
  if (round == 2 && piece_.rank == kWriter)
    write_pvtu(path_, piece_.ranks, arrays_of_series(piece_, ghosted_ != nullptr));
}

std::vector<Rank> WritePieces::senders(int) const {
  return all_ranks(piece_.ranks);
}

void WritePieces::receive(int, std::vector<Mail> mail) {
  throw_first_failure(mail);
}

/// As many pieces at a time as there are threads, so that the calling thread, whose files wait for each other, commits.
void write_series(const std::string& path, std::int32_t pieces, std::size_t threads,
                  const std::function<DistributedPiece(Rank)>& make) {
  StagedFiles files;
  VtuArrays arrays;
  for (std::int32_t first = 0; first < pieces; first += static_cast<std::int32_t>(threads)) {
    std::vector<std::unique_ptr<FileSink>> made(std::min(threads, to_index(pieces - first)));
    in_parts(made.size(), made.size(), [&](std::size_t i, std::size_t, std::size_t) {
      const Rank k{first + static_cast<std::int32_t>(i)};
      const DistributedPiece piece = make(k);
      if (k == Rank{0}) arrays = arrays_of_series(piece, false);
      made[i] = prepare_piece(piece, nullptr, path);
    });
    for (const auto& file : made) file->commit();
  }
  write_pvtu(path, pieces, arrays);
  files.commit();
}

void write_ghosted_series(const std::string& path, std::int32_t pieces,
                          const std::function<DistributedPiece(Rank)>& make) {
  std::vector<DistributedPiece> made;
  for (std::int32_t k = 0; k < pieces; ++k) made.push_back(make(Rank{k}));
  std::vector<std::unique_ptr<GhostLayer>> layers;
  IdVector<Rank, Exchange*> all;
  for (const DistributedPiece& piece : made) {
    layers.push_back(std::make_unique<GhostLayer>(piece));
    all.push_back(layers.back().get());
  }
  exchange_directly(all);
  StagedFiles files;
  for (std::size_t k = 0; k < made.size(); ++k) {
    const GhostedPiece ghosted = layers[k]->take();
    prepare_piece(made[k], &ghosted, path)->commit();
  }
  write_pvtu(path, pieces, arrays_of_series(made.front(), true));
  files.commit();
}

WriteWhole::WriteWhole(const DistributedPiece& piece, const Mesh& whole, std::string path, WriteOptions options)
    : piece_(piece), whole_(whole), path_(std::move(path)), options_(std::move(options)) {}

std::vector<Mail> WriteWhole::send(int) {
  if (piece_.rank != kWriter) return {};
  return status_to_all(piece_.ranks, [&] { write_mesh(whole_, path_, options_); });
}

std::vector<Rank> WriteWhole::senders(int) const {
  return {kWriter};
}

void WriteWhole::receive(int, std::vector<Mail> mail) {
  throw_first_failure(mail);
}

namespace {

/// Formats that all ranks write, by their first extensions.
struct WriterOfRanks {
  std::string_view extension;
  void (*write)(ExchangeRunner& ranks, const DistributedPiece& piece, const std::string& path,
                const WriteOptions& options);
};

void write_pieces(ExchangeRunner& ranks, const DistributedPiece& piece, const std::string& path,
                  const WriteOptions& options) {
  std::optional<GhostedPiece> ghosted;
  if (options.ghost_layer) {
    GhostLayer layer(piece);
    ranks.run(layer);
    ghosted = layer.take();
  }
  WritePieces pieces(piece, path, ghosted ? &*ghosted : nullptr);
  ranks.run(pieces);
}

template <class Writing>
void write_by(ExchangeRunner& ranks, const DistributedPiece& piece, const std::string& path, const WriteOptions&) {
  Writing writing(piece, path);
  ranks.run(writing);
}

constexpr WriterOfRanks kWritersOfRanks[] = {
    {".pvtu", write_pieces}, {".pmesh", write_by<WriteMfem>}, {".h5", write_by<WriteTogether>}};

/// Null for a format that one rank writes.
const WriterOfRanks* writer_of_ranks(const std::string& path) {
  const auto* const writer =
      std::ranges::find(kWritersOfRanks, format_of(path).extensions.front(), &WriterOfRanks::extension);
  return writer == std::end(kWritersOfRanks) ? nullptr : writer;
}

}  // namespace

bool is_written_by_all(const std::string& path) {
  return writer_of_ranks(path) != nullptr;
}

void write_distributed(ExchangeRunner& ranks, const DistributedPiece& piece, std::span<const std::string> paths,
                       const WriteOptions& options, const std::function<void(const std::string&)>& begins) {
  std::optional<GatherPieces> gathered;
  for (const std::string& path : paths) {
    if (begins) begins(path);
    if (const WriterOfRanks* const writer = writer_of_ranks(path)) {
      if (const std::string wanted = coordinates_wanted(piece.mesh, path, options); wanted.empty()) {
        writer->write(ranks, piece, path, options);
      } else {
        DistributedPiece moved = piece;
        change_coordinates(moved.mesh, wanted, path);
        writer->write(ranks, moved, path, options);
      }
      continue;
    }
    if (!gathered) ranks.run(gathered.emplace(piece));
    WriteWhole whole(piece, gathered->whole(), path, options);
    ranks.run(whole);
  }
}

}  // namespace driftmesh
