#pragma once

#include <vector>

#include "distributed/census.hpp"
#include "distributed/exchange.hpp"
#include "distributed/held_subdomains.hpp"
#include "distributed/numbering.hpp"
#include "distributed/piece_places.hpp"
#include "driftmesh/distributed_piece.hpp"
#include "driftmesh/pslg.hpp"

namespace driftmesh {

/// Assembles a distributed mesh from the subdomains that ranks hold: finds out who holds what, checks that both sides
/// of every shared root have the same points, and numbers the vertices. Takes two rounds of messages; then piece()
/// returns the part of this rank.
///
/// - Round 1: every rank tells every rank which subdomains it holds, and how many vertices each of them owns.
/// - Round 2: ranks with a common root send each other a digest of the points they have on it; the side that owns the
///   root adds the number of the first one.
///
/// Throws Error, naming the subdomain or root and the ranks, if a subdomain is held by no rank or by several, or if the
/// sides of a root have different points.
class PieceAssembly final : public Exchange {
 public:
  /// The decomposition outlives the object. `held` is called here and in piece().
  PieceAssembly(Rank rank, std::int32_t ranks, const Decomposition& decomposition, const HeldSubdomains& held);
  /// The same with the census of these subdomains, which spares the first of the two calls.
  PieceAssembly(Rank rank, std::int32_t ranks, const Decomposition& decomposition, HeldSubdomains held,
                std::vector<SubdomainCensus> census);

  [[nodiscard]] int rounds() const override { return 2; }
  [[nodiscard]] std::vector<Mail> send(int round) override;
  [[nodiscard]] std::vector<Rank> senders(int round) const override;
  void receive(int round, std::vector<Mail> mail) override;

  /// After the exchange. `pslg` is the (repaired) input that the decomposition was made from: markers, attributes and
  /// regions come from it. Throws Error if the coordinates of a point differ between two subdomains of this rank.
  /// `places`: if not null, where it notes the place of all vertices.
  [[nodiscard]] DistributedPiece piece(const Pslg& pslg, PiecePlaces* places = nullptr) const;

  // After the exchange, too:

  [[nodiscard]] const SubdomainTable& subdomains() const { return subdomains_; }
  /// Those of this rank, ascending.
  [[nodiscard]] const std::vector<NumberedRoot>& roots() const { return roots_; }

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
  std::vector<NumberedRoot> roots_;  // roots on this rank, ascending
  std::vector<Rank> neighbors_;      // ranks with a common root, ascending
};

}  // namespace driftmesh
