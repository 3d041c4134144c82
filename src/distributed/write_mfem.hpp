#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "distributed/exchange.hpp"
#include "driftmesh/distributed_piece.hpp"
#include "io/mfem_format.hpp"

namespace driftmesh {

/// Writes each rank's part of a mesh for a ParMesh of MFEM, into a file of its own, with the points and edges that it
/// shares with others. All files appear, or if one rank fails, all throw what it threw.
///
/// - Round 1: ranks tell all others their regions and markers, and their neighbors the edges on their rims.
/// - Rounds 2 and 3: all write, then commit.
class WriteMfem final : public Exchange {
 public:
  /// `piece` must outlive the object.
  WriteMfem(const DistributedPiece& piece, std::string path);

  [[nodiscard]] int rounds() const override { return 3; }
  [[nodiscard]] std::vector<Mail> send(int round) override;
  [[nodiscard]] std::vector<Rank> senders(int round) const override;
  void receive(int round, std::vector<Mail> mail) override;

 private:
  using Ends = std::array<std::int64_t, 2>;  // the numbers of an edge's points, ascending
  using Edge = std::array<std::int32_t, 2>;  // their indices in the piece, in the same direction

  void find_rim();
  [[nodiscard]] std::vector<Mail> describe() const;
  [[nodiscard]] std::vector<Ends> rim_along(const DistributedPiece::Neighbor& with) const;
  void learn(const std::vector<Mail>& mail);
  void group_points();
  MfemGroup& group_of(const std::vector<std::int32_t>& ranks);
  void bound();

  const DistributedPiece& piece_;
  std::string path_;
  std::map<Ends, Edge> rim_;  // edges with one triangle of the piece; later those that bound the domain
  std::map<std::vector<std::int32_t>, MfemGroup> groups_;  // by their ranks
  MfemPart part_;
  std::unique_ptr<FileSink> file_;
};

}  // namespace driftmesh
