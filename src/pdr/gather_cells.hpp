#pragma once

#include <cstdint>
#include <vector>

#include "distributed/exchange.hpp"
#include "driftmesh/mesh.hpp"
#include "driftmesh/pslg.hpp"
#include "mesh/triangulation.hpp"
#include "pdr/cell_refiner.hpp"

namespace driftmesh::pdr {

/// The triangles of a rank's own cells, as to_piece() has them. Input points come first, used or not.
[[nodiscard]] Mesh own_triangles(const Triangulation& mesh, const Pslg& pslg, const CellRefiner& cells,
                                 const Lattice& lattice, Rank rank);

/// Removes the triangles of other ranks' cells. What is left can be measured, not refined.
void keep_own_triangles(Triangulation& mesh, const CellRefiner& cells, const Lattice& lattice, Rank rank);

/// What a rank has of the whole mesh, whose triangles each belong to one rank, and so do points and subsegments: to the
/// rank of the cell in which they, or their first ends, lie.
struct OwnCounts {
  std::int64_t vertices = 0, subsegments = 0;
};
[[nodiscard]] OwnCounts count_own(const Triangulation& mesh, const Lattice& lattice, Rank rank);

/// Gathers what the ranks have on rank 0, and makes one mesh of it.
class GatherCells : public Exchange {
 public:
  /// `own`: this rank's own_triangles.
  GatherCells(Rank rank, std::int32_t ranks, Mesh own) : rank_(rank), ranks_(ranks), own_(std::move(own)) {}

  [[nodiscard]] int rounds() const override { return 1; }
  [[nodiscard]] std::vector<Mail> send(int round) override;
  [[nodiscard]] std::vector<Rank> senders(int round) const override;
  /// Throws Error if the pieces do not fit together: then refinement has made a mistake.
  void receive(int round, std::vector<Mail> mail) override;

  /// On rank 0, after the exchange: the whole mesh.
  [[nodiscard]] Mesh& whole() { return whole_; }

 private:
  Rank rank_;
  std::int32_t ranks_;
  Mesh own_, whole_;
};

}  // namespace driftmesh::pdr
