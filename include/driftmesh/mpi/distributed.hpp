#pragma once

#include <mpi.h>

#include <string>

#include "driftmesh/distributed_piece.hpp"
#include "driftmesh/options.hpp"
#include "driftmesh/pslg.hpp"

namespace driftmesh {

/// Makes a mesh of `input` on all ranks of a communicator, each of which gets its piece. All ranks call it together,
/// after MPI_Init. Messages travel on duplicates of the communicator, so they cannot meet the caller's.
///
/// The input of rank 0 counts, and so do its options, but for the callables: MeshOptions::size and
/// MeshOptions::balance.own are each rank's own and must do the same everywhere, and each rank's own
/// MeshOptions::progress is told of its subdomains, and can cancel the work of all. What holds for the mesh of mesh()
/// holds for the pieces together; in addition, ranks agree on every point that they share.
///
/// Errors are those of mesh(), thrown on all ranks alike: what one rank meets by itself, also in a callable, ends the
/// work of all in good order, as an error of the same kind that names the rank. Only where memory runs out between
/// refinement and the finished pieces, MPI fails, or a policy of the caller's own throws, the job ends with a message.
[[nodiscard]] DistributedPiece mesh_distributed(MPI_Comm communicator, const Pslg& input,
                                                const MeshOptions& options = {});

/// Writes the pieces of all ranks, which call it together: one file each and one that names them if `path` ends in
/// .pvtu, otherwise one file in the format that the extension names, gathered on rank 0, which needs memory for the
/// whole mesh. Files appear when they are complete. Throws InputError and FileError, on all ranks if one cannot write.
void write_distributed(MPI_Comm communicator, const DistributedPiece& piece, const std::string& path);

}  // namespace driftmesh
