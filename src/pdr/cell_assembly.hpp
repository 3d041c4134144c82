#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "distributed/exchange.hpp"
#include "driftmesh/distributed_piece.hpp"
#include "driftmesh/id_vector.hpp"
#include "driftmesh/pslg.hpp"
#include "mesh/triangulation.hpp"
#include "pdr/cell_refiner.hpp"
#include "pdr/lattice.hpp"

namespace driftmesh::pdr {

/// Makes a distributed mesh of what ranks have refined: each has the triangles of its own cells, and knows from those
/// around them which vertices it shares with whom. A vertex belongs to the lowest of its ranks. Vertices are numbered
/// rank by rank. Takes two rounds of messages; then piece() returns the part of this rank.
///
/// - Round 1: every rank tells every rank how many vertices, triangles and subsegments it has of its own.
/// - Round 2: ranks with common vertices send each other a digest of these and of the edges between their cells, and
///   the numbers of those that they own.
///
/// Throws Error if two ranks differ in what they have in common: then refinement has made a mistake.
class CellAssembly final : public Exchange {
 public:
  /// `mesh`, `cells` and `lattice` outlive the object.
  CellAssembly(Rank rank, std::int32_t ranks, const Triangulation& mesh, const CellRefiner& cells,
               const Lattice& lattice);

  [[nodiscard]] int rounds() const override { return 2; }
  [[nodiscard]] std::vector<Mail> send(int round) override;
  [[nodiscard]] std::vector<Rank> senders(int round) const override;
  void receive(int round, std::vector<Mail> mail) override;

  // After the exchange:

  /// `pslg` is the (repaired) input: markers, attributes and regions come from it. The whole mesh is one subdomain: it
  /// has no interfaces.
  [[nodiscard]] DistributedPiece piece(const Pslg& pslg) const;
  /// Of the whole mesh, each counted once.
  [[nodiscard]] std::int64_t total_subsegments() const { return total_.subsegments; }

 private:
  struct Counts {
    std::int64_t vertices = 0, triangles = 0, subsegments = 0;
  };
  /// What this rank has in common with another one.
  struct Seam {
    std::vector<VertexId> vertices;  ///< in the order of their coordinates
    std::uint64_t edges = 0;         ///< a digest that does not depend on their order
  };

  void find_triangles();
  void find_seams();
  void number_own_vertices(std::int64_t first);
  [[nodiscard]] std::uint64_t digest_of(const Seam& seam) const;
  [[nodiscard]] std::vector<Mail> tell_counts() const;
  [[nodiscard]] std::vector<Mail> tell_numbers() const;
  void learn_counts(const std::vector<Mail>& mail);
  void learn_numbers(const Mail& mail);
  [[nodiscard]] std::vector<VertexId> vertices_by_number() const;
  using Places = IdVector<VertexId, std::int32_t>;  ///< in the piece
  void add_triangles(const Places& place, const Pslg& pslg, Mesh& piece) const;
  void add_edges(const Places& place, Mesh& piece) const;
  void mark_points(const std::vector<VertexId>& vertices, const Pslg& pslg, Mesh& piece) const;
  void set_attributes(const std::vector<VertexId>& vertices, const Pslg& pslg, Mesh& piece) const;

  Rank rank_;
  std::int32_t ranks_;
  const Triangulation& mesh_;
  const CellRefiner& cells_;
  const Lattice& lattice_;
  IdVector<VertexId, Rank> owner_;           ///< of the vertices here; kNone elsewhere
  IdVector<VertexId, std::int64_t> number_;  ///< in the whole mesh
  std::vector<TriangleId> triangles_;        ///< of the rank's cells
  std::map<Rank, Seam> seams_;
  Counts own_, total_;
};

}  // namespace driftmesh::pdr
