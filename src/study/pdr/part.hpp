#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "distributed/exchange.hpp"
#include "job/mesh_facts.hpp"
#include "mesh/triangulation.hpp"
#include "study/pdr/cell_refiner.hpp"
#include "study/pdr/lattice.hpp"

namespace driftmesh::pdr {

/// Refines `mesh`, triangulated and with its corners prepared, as far as partially coupled refinement needs it, and
/// lays a lattice for this number of ranks over it, with cells of many times its largest circumradius. Sequential and
/// deterministic: each rank does it and gets the same. Throws Error unless bounds.plain.area is positive, there is no
/// size field, and the bound on angles is positive.
[[nodiscard]] Lattice start(Triangulation& mesh, const QualityBounds& bounds, std::int32_t ranks);

/// One rank's part in partially coupled parallel Delaunay refinement (Chernikov and Chrisochoides 2004, 2006). In each
/// round all cells of one color are refined at once, and ranks tell each other what they did in cells that others
/// follow. Colors take turns until in a whole turn nobody has done anything.
class Part final : public Exchange {
 public:
  /// `started` and its lattice are what start() makes, the same on all ranks, as are the bounds. `worked` is called
  /// whenever the mesh may have changed, before anybody hears of it.
  Part(
      Rank rank, std::int32_t ranks, Triangulation started, const Lattice& lattice, const QualityBounds& bounds,
      std::function<void()> worked = [] {});

  [[nodiscard]] int rounds() const override { return rounds_; }
  [[nodiscard]] std::vector<Mail> send(int round) override;
  [[nodiscard]] std::vector<Rank> senders(int round) const override;
  void receive(int round, std::vector<Mail> mail) override;

  [[nodiscard]] const Triangulation& mesh() const { return mesh_; }
  [[nodiscard]] const CellRefiner& cells() const { return cells_; }
  /// Changes told so far, once for each rank that heard of them.
  [[nodiscard]] std::int64_t told() const { return told_; }

  /// Removes the triangles of other ranks' cells, after which the mesh can be refined no more, and says what is left.
  /// Points and subsegments of the whole mesh each count for one rank: that of the cell in which they, or their first
  /// ends, lie.
  [[nodiscard]] job::MeshFacts keep_own(const QualityBounds& bounds);

 private:
  Rank rank_;
  std::int32_t ranks_;
  Triangulation mesh_;
  Lattice lattice_;
  CellRefiner cells_;
  std::vector<Rank> neighbors_;
  std::function<void()> worked_;
  int rounds_ = Lattice::kColors;
  bool changed_ = false;  // by anyone in this turn, as far as known
  std::int64_t told_ = 0;
};

}  // namespace driftmesh::pdr
