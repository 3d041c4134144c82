#pragma once

#include <cstdint>
#include <utility>

#include "mesh/bounds.hpp"
#include "mesh/triangulation.hpp"
#include "study/pdr/lattice.hpp"
#include "study/pdr/lattice_refinement.hpp"

namespace driftmesh::pdr {

/// One rank's mesh and its share of the refinement.
struct Part {
  Triangulation mesh;
  Lattice lattice;
  LatticeRefinement refinement;

  /// `started` and its lattice are what start() makes; `bounds` outlives the object.
  Part(Rank rank, std::int32_t ranks, Triangulation started, const Lattice& of_start, const QualityBounds& bounds)
      : mesh(std::move(started)), lattice(of_start), refinement(rank, ranks, mesh, bounds, lattice) {}
  Part(const Part&) = delete;
  Part& operator=(const Part&) = delete;
};

}  // namespace driftmesh::pdr
