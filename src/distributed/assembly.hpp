#pragma once

#include <vector>

#include "distributed/census.hpp"
#include "distributed/exchange.hpp"
#include "distributed/held_subdomains.hpp"
#include "distributed/numbering.hpp"
#include "driftmesh/distributed_piece.hpp"
#include "driftmesh/pslg.hpp"

namespace driftmesh {

/// Makes one distributed mesh of the subdomains that ranks hold: who holds what, equal points on both sides of every
/// shared root, one number for each vertex. Two rounds of messages; then piece() says what this rank has.
///
/// - Round 1: every rank tells every rank which subdomains it holds, and how many vertices each of them owns.
/// - Round 2: ranks with a common root tell each other which points they have on it, as a digest; the side that owns
///   the root adds the number of the first one.
///
/// Errors name the subdomain or root and the ranks: a subdomain that no rank or more than one rank holds, sides of a
/// root with different points.
class PieceAssembly final : public Exchange {
 public:
  /// The decomposition outlives the object. `held` is called here and in piece().
  PieceAssembly(Rank rank, std::int32_t ranks, const Decomposition& decomposition, HeldSubdomains held);

  [[nodiscard]] int rounds() const override { return 2; }
  [[nodiscard]] std::vector<Mail> send(int round) override;
  [[nodiscard]] std::vector<Rank> senders(int round) const override;
  void receive(int round, std::vector<Mail> mail) override;

  /// After the conversation. `pslg` is the (repaired) input that the decomposition was made from: markers, attributes
  /// and regions come from it. Throws Error if the coordinates of a point differ between two subdomains of this rank.
  [[nodiscard]] DistributedPiece piece(const Pslg& pslg) const;

 private:
  [[nodiscard]] Rank holder(SubdomainId i) const { return subdomains_.rank[i]; }
  [[nodiscard]] std::vector<Mail> announce() const;
  [[nodiscard]] std::vector<Mail> describe_roots();
  void learn_subdomains(const std::vector<Mail>& mail);
  void number_owned_roots();
  void compare_own_sides() const;
  void learn_roots(const Mail& mail);

  Rank rank_;
  std::int32_t ranks_;
  const Decomposition& decomposition_;
  HeldSubdomains held_;
  std::vector<SubdomainCensus> census_;
  SubdomainTable subdomains_;
  std::vector<NumberedRoot> roots_;  // of this rank, ascending
  std::vector<Rank> neighbors_;      // ranks with a common root, ascending
};

}  // namespace driftmesh
