#pragma once

#include <mpi.h>

#include <string>

#include "driftmesh/distributed_piece.hpp"
#include "driftmesh/ghosted_piece.hpp"
#include "driftmesh/options.hpp"
#include "driftmesh/pslg.hpp"

namespace driftmesh {

/// Makes a mesh of `input` on all ranks of a communicator, each of which gets its piece. Collective; to be called after
/// MPI_Init. Messages travel on duplicates of the communicator, so they cannot interfere with the caller's.
///
/// The input, and a given decomposition, are those of rank 0. All other options must be the same on every rank, or all
/// throw an Error that names the option and the ranks. Every rank uses its own MeshOptions::size and
/// MeshOptions::balance.own, which must behave identically everywhere: where sizes are found to differ, at an end or
/// the middle of a line between subdomains, all ranks throw an Error with the point and both values. Every rank's own
/// MeshOptions::progress is called for its subdomains, and can cancel the work of all ranks. The pieces together have
/// the properties of mesh(); in addition, ranks agree on every shared point.
///
/// Errors are those of mesh(), thrown on all ranks: an error on a single rank, even in a callable, ends the work of all
/// ranks in an orderly way, with an error of the same type that names the rank. Error also if MPI is not running, and
/// for MPI_COMM_NULL and intercommunicators. Only if memory runs out between refinement and the finished pieces,
/// or MPI fails, does the job end with a message.
///
/// \code
/// driftmesh::MeshOptions options{.max_area = 20};
/// options.balance.policy = "stealing";
/// const auto piece = driftmesh::mesh_distributed(MPI_COMM_WORLD, driftmesh::generate("pipe"), options);
/// std::cout << piece.mesh.triangles.size() << " of " << piece.total_triangles << " triangles\n";
/// driftmesh::write_distributed(MPI_COMM_WORLD, piece, "pipe.pvtu");
/// \endcode
[[nodiscard]] DistributedPiece mesh_distributed(MPI_Comm communicator, const Pslg& input,
                                                const MeshOptions& options = {});

/// The pieces of all ranks, each with a ring of ghost triangles around it (see GhostedPiece). Collective, in one round
/// of messages; nothing is gathered but two numbers for each subdomain. Takes what mesh_distributed returned, on the
/// same communicator, or one of the same ranks in the same order. Throws Error, on the rank concerned, if pieces do not
/// belong together.
[[nodiscard]] GhostedPiece add_ghost_layer(MPI_Comm communicator, const DistributedPiece& piece);

/// Writes the pieces of all ranks. Collective. If `path` ends in .pvtu, writes one file per rank and one that lists
/// them; if in .pmesh, one per rank for a ParMesh of MFEM; if in .h5, all write one together; otherwise one file in the
/// format given by the extension, gathered on rank 0, which needs memory for the whole mesh. Files appear only when
/// complete. Throws InputError and FileError, on all ranks if one cannot write.
void write_distributed(MPI_Comm communicator, const DistributedPiece& piece, const std::string& path);

}  // namespace driftmesh
