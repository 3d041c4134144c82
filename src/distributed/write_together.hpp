#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "base/atomic_file.hpp"
#include "distributed/exchange.hpp"
#include "driftmesh/distributed_piece.hpp"
#include "io/hdf5_format.hpp"

namespace driftmesh {

/// The arrays in files of all pieces, the same whatever this one happens to hold.
[[nodiscard]] VtuArrays arrays_of_pieces(const DistributedPiece& piece);

/// Writes a mesh from all ranks into one .h5 file: each point by its owner, each triangle by the rank that has it, and
/// a subsegment between ranks by the first of them. The rows of a rank are consecutive. The file and the .xdmf beside
/// it appear when all ranks have written their rows; if one fails, all throw what it threw.
///
/// - Round 1: every rank tells every rank how much it has, and the ranks that come after it which subsegments they may
///   both have.
/// - Round 2: ranks tell all how many subsegments they write, and their neighbors the rows of the points they own.
/// - Round 3: rank 0 makes the file, and tells where its arrays are.
/// - Rounds 4 and 5: all write; rank 0 commits.
class WriteTogether final : public Exchange {
 public:
  /// `piece` must outlive the object. `path` is in a folder that all ranks share.
  WriteTogether(const DistributedPiece& piece, std::string path);

  [[nodiscard]] int rounds() const override { return 5; }
  [[nodiscard]] std::vector<Mail> send(int round) override;
  [[nodiscard]] std::vector<Rank> senders(int round) const override;
  void receive(int round, std::vector<Mail> mail) override;

 private:
  using Ends = std::array<std::int64_t, 2>;  // the numbers of a subsegment's points, ascending

  [[nodiscard]] Ends ends_of(std::int32_t edge) const;
  [[nodiscard]] const DistributedPiece::Neighbor* neighbor(Rank rank) const;
  [[nodiscard]] std::vector<Ends> shared_edges(const DistributedPiece::Neighbor& with) const;
  [[nodiscard]] std::vector<Mail> describe() const;
  void learn_counts(const std::vector<Mail>& mail);
  [[nodiscard]] std::vector<Mail> tell_rows() const;
  void learn_rows(const std::vector<Mail>& mail);
  [[nodiscard]] std::vector<Mail> make_file();
  void learn_places(const Mail& mail);

  const DistributedPiece& piece_;
  std::string path_;
  Hdf5Shape shape_;
  Hdf5Part part_;
  std::unique_ptr<AtomicFile> file_;  // only on rank 0
  std::string name_;                  // what the file is called meanwhile
  Hdf5Places places_;
};

}  // namespace driftmesh
