#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "distributed/exchange.hpp"
#include "driftmesh/distributed_piece.hpp"
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

  /// After the conversation: on rank 0 the whole mesh, the same for every distribution of the same subdomains but for
  /// Mesh::ranks; on others nothing.
  [[nodiscard]] const Mesh& whole() const { return whole_; }

 private:
  void merge();

  const DistributedPiece& piece_;
  std::vector<Mail> pieces_;  // as they came
  Mesh whole_;
};

/// Writes a mesh from all ranks at once, each its piece (mesh_0.vtu, mesh_1.vtu, ... beside mesh.pvtu). No file gets
/// its name before all pieces are complete, the .pvtu last. If one rank cannot write, all throw a FileError that names
/// it.
class WritePieces final : public Exchange {
 public:
  /// `piece` must outlive the object. `path` ends in .pvtu and is in a folder that all ranks share.
  WritePieces(const DistributedPiece& piece, std::string path);

  [[nodiscard]] int rounds() const override { return 3; }
  [[nodiscard]] std::vector<Mail> send(int round) override;
  [[nodiscard]] std::vector<Rank> senders(int round) const override;
  void receive(int round, std::vector<Mail> mail) override;

 private:
  void write_or_commit(int round);

  const DistributedPiece& piece_;
  std::string path_;
  std::unique_ptr<FileSink> file_;  // written, and not yet under its name
};

/// Writes a mesh that rank 0 has gathered, and tells the others how that went: on failure, all throw.
class WriteWhole final : public Exchange {
 public:
  /// `whole` (of rank 0; ignored elsewhere) outlives the object.
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

/// Writes the mesh to each of `paths` from all ranks together: in pieces if it ends in .pvtu, else as one file of any
/// format that write_mesh knows, which takes the memory for the whole mesh on rank 0. If one rank fails, all throw.
void write_distributed(ExchangeRunner& ranks, const DistributedPiece& piece, std::span<const std::string> paths,
                       const WriteOptions& options = {});

}  // namespace driftmesh
