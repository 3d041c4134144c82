#pragma once

#include <cstdint>
#include <string>

#include "decompose/decomposition.hpp"
#include "distributed/distributed_piece.hpp"
#include "driftmesh/pslg.hpp"
#include "driftmesh/size_field.hpp"

/// driftmesh inside a solver: the ranks of a job make a mesh together, and each gets its piece of it in memory.
/// examples/laplace.cpp shows the whole way.
namespace driftmesh {

/// What the mesh must be like, and how it is made. The same on every rank; what a member means and its limits are those
/// of the option of `driftmesh mesh` with its name.
struct DistributedOptions {
  double min_angle = 20;            ///< degrees
  double max_area = 0;              ///< 0: no bound
  bool region_areas = true;         ///< whether the regions' own area bounds hold
  const SizeField* size = nullptr;  ///< target edge lengths, or null; not owned. The same function on every rank
  std::int32_t subdomains = 0;      ///< 0: as suits the size of the mesh and the number of ranks
  std::string mapping = "graph";    ///< how subdomains are dealt to ranks
  std::string presplit = "auto";    ///< whether interfaces are cut to size before refinement
  std::string balance = "none";     ///< the policy by which subdomains move from slow ranks to fast ones
};

/// Makes a mesh of `input` on all ranks of a communicator, which all call it together. `communicator` is the Fortran
/// handle of it (MPI_Comm_c2f); MPI has been initialized. Only the input of rank 0 counts; it may be as users feed it,
/// and is repaired first.
///
/// Throws Error, on all ranks alike, for inputs and options that allow no mesh. An error that one rank alone meets
/// later (no memory, coordinates without room for a point) ends the job with a message, like errors of MPI do.
[[nodiscard]] DistributedPiece mesh_distributed(int communicator, const Pslg& input, const DistributedOptions& options);

/// The same with a decomposition that was made before from the same input, after repair (see decompose, and
/// read_decomposition). Both are those of rank 0; options.subdomains is ignored.
[[nodiscard]] DistributedPiece mesh_distributed(int communicator, const Pslg& input, const Decomposition& decomposition,
                                                const DistributedOptions& options);

/// Writes a piece from all ranks together, which all call it: as pieces if `path` ends in .pvtu, else as one file that
/// rank 0 gathers, in the format that the extension names. Throws Error on all ranks if that fails on one.
void write_distributed(int communicator, const DistributedPiece& piece, const std::string& path);

}  // namespace driftmesh
