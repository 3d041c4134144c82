#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "distributed/exchange.hpp"
#include "study/pdr/cell_refiner.hpp"

namespace driftmesh::pdr {

/// One rank's part of partially coupled parallel Delaunay refinement (Chernikov and Chrisochoides 2004, 2006). In each
/// round all cells of one color are refined at once, and ranks tell each other what they did in cells that others
/// follow. Colors take turns until in a whole turn nobody has done anything.
class LatticeRefinement : public Exchange {
 public:
  /// All ranks give the same mesh (see start), bounds and lattice. The arguments outlive the object.
  LatticeRefinement(Rank rank, std::int32_t ranks, Triangulation& mesh, const QualityBounds& bounds,
                    const Lattice& lattice);

  [[nodiscard]] int rounds() const override { return rounds_; }
  [[nodiscard]] std::vector<Mail> send(int round) override;
  [[nodiscard]] std::vector<Rank> senders(int round) const override;
  void receive(int round, std::vector<Mail> mail) override;

  /// What this rank has told others so far.
  struct Traffic {
    std::int64_t messages = 0;
    std::int64_t bytes = 0;
    std::int64_t points = 0;
  };
  [[nodiscard]] const Traffic& traffic() const { return traffic_; }
  [[nodiscard]] const CellRefiner& cells() const { return refiner_; }

 private:
  Rank rank_;
  std::int32_t ranks_;
  const Lattice& lattice_;
  CellRefiner refiner_;
  std::vector<Rank> neighbors_;
  int rounds_ = Lattice::kColors;
  bool changed_ = false;  // by anyone in this turn, as far as known
  Traffic traffic_;
};

}  // namespace driftmesh::pdr
