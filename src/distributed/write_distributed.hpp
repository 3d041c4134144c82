#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "distributed/exchange.hpp"
#include "driftmesh/distributed_piece.hpp"
#include "driftmesh/ghosted_piece.hpp"
#include "io/file_sink.hpp"
#include "io/mesh_file.hpp"

namespace driftmesh {

/// Gathers the pieces of all ranks on rank 0, which merges them. On failure, all ranks throw.
class GatherPieces final : public Exchange {
 public:
  /// `piece` must outlive the object.
  explicit GatherPieces(const DistributedPiece& piece) : piece_(piece) {}

  [[nodiscard]] int rounds() const override { return 2; }
  [[nodiscard]] std::vector<Mail> send(int round) override;
  [[nodiscard]] std::vector<Rank> senders(int round) const override;
  void receive(int round, std::vector<Mail> mail) override;

  /// After the exchange: on rank 0 the whole mesh, which, except for Mesh::ranks, is the same for every distribution of
  /// the same subdomains; empty on other ranks.
  [[nodiscard]] const Mesh& whole() const { return whole_; }

 private:
  void merge();

  const DistributedPiece& piece_;
  std::vector<Mail> pieces_;  // from the other ranks, as they came
  Mesh whole_;
};

/// Writes a mesh from all ranks in parallel, each its own piece (mesh_0.vtu, mesh_1.vtu, ... next to mesh.pvtu). No
/// file appears under its name before all pieces are complete; the .pvtu appears last. If one rank cannot write, all
/// throw a FileError that names it.
class WritePieces final : public Exchange {
 public:
  /// `piece` must outlive the object. `path` ends in .pvtu and is in a folder that all ranks share. `ghosted`: the same
  /// piece with ghosts, which are to be in the files, likewise; null: without. The same on all ranks.
  WritePieces(const DistributedPiece& piece, std::string path, const GhostedPiece* ghosted = nullptr);

  [[nodiscard]] int rounds() const override { return 3; }
  [[nodiscard]] std::vector<Mail> send(int round) override;
  [[nodiscard]] std::vector<Rank> senders(int round) const override;
  void receive(int round, std::vector<Mail> mail) override;

 private:
  void write_or_commit(int round);

  const DistributedPiece& piece_;
  const GhostedPiece* ghosted_;
  std::string path_;
  std::unique_ptr<FileSink> file_;  // complete, but not yet under its name
};

/// Writes a .pvtu of `pieces` pieces, each made by make(its number) when it is written, in `threads` threads. All files
/// appear together (see StagedFiles).
void write_series(const std::string& path, std::int32_t pieces, std::size_t threads,
                  const std::function<DistributedPiece(Rank)>& make);

/// The same with a ring of ghost triangles in each piece. Takes memory for all pieces at once.
void write_ghosted_series(const std::string& path, std::int32_t pieces,
                          const std::function<DistributedPiece(Rank)>& make);

/// Writes a mesh that rank 0 has gathered. On failure, all ranks throw.
class WriteWhole final : public Exchange {
 public:
  /// `whole`, which matters only on rank 0, must outlive the object.
  WriteWhole(const DistributedPiece& piece, const Mesh& whole, std::string path, WriteOptions options = {});

  [[nodiscard]] int rounds() const override { return 1; }
  [[nodiscard]] std::vector<Mail> send(int round) override;
  [[nodiscard]] std::vector<Rank> senders(int round) const override;
  void receive(int round, std::vector<Mail> mail) override;

 private:
  const DistributedPiece& piece_;
  const Mesh& whole_;
  std::string path_;
  WriteOptions options_;
};

/// Whether ranks write it together, so that none of them has the whole mesh: .pvtu, .h5 and .pmesh. Errors: as
/// format_of.
[[nodiscard]] bool is_written_by_all(const std::string& path);

/// Writes the mesh to each of `paths`; all ranks call it together. What is not written by all takes memory for the
/// whole mesh on rank 0. Each rank calls begins(path) before it begins with one, if that is not empty. If one rank
/// fails, all throw.
void write_distributed(ExchangeRunner& ranks, const DistributedPiece& piece, std::span<const std::string> paths,
                       const WriteOptions& options = {}, const std::function<void(const std::string&)>& begins = {});

}  // namespace driftmesh
