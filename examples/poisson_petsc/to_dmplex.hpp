#pragma once

#include <mpi.h>
#include <petscdmplex.h>
#include <petscsf.h>

#include <algorithm>
#include <cstddef>
#include <driftmesh/mpi/distributed.hpp>
#include <string>
#include <vector>

// The mesh of all ranks as a DMPlex of PETSc (3.18 or later), each rank with its piece: nothing is gathered or moved.
// All that PETSc needs is in this header, which can be copied into a solver; driftmesh itself does not link PETSc.

namespace driftmesh::petsc {

/// For each point of the piece its index on the rank that owns it. Collective.
inline std::vector<std::int32_t> places_at_owners(MPI_Comm communicator, const DistributedPiece& piece) {
  const std::size_t neighbors = piece.neighbors.size();
  std::vector<std::vector<std::int32_t>> received(neighbors);
  std::vector<MPI_Request> requests(2 * neighbors);
  for (std::size_t k = 0; k < neighbors; ++k) {
    const auto& [rank, shared] = piece.neighbors[k];
    received[k].resize(shared.size());
    const int count = static_cast<int>(shared.size());
    MPI_Irecv(received[k].data(), count, MPI_INT32_T, to_int(rank), 0, communicator, &requests[2 * k]);
    MPI_Isend(shared.data(), count, MPI_INT32_T, to_int(rank), 0, communicator, &requests[2 * k + 1]);
  }
  MPI_Waitall(static_cast<int>(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
  std::vector<std::int32_t> places(piece.owners.size());
  for (std::size_t v = 0; v < places.size(); ++v) places[v] = static_cast<std::int32_t>(v);
  for (std::size_t k = 0; k < neighbors; ++k)
    for (std::size_t i = 0; i < received[k].size(); ++i) {
      const auto v = static_cast<std::size_t>(piece.neighbors[k].shared[i]);
      if (piece.owners[v] == piece.neighbors[k].rank) places[v] = received[k][i];
    }
  return places;
}

/// The star forest: points that another rank owns point to it.
inline PetscErrorCode set_star_forest(DM plex, MPI_Comm communicator, const DistributedPiece& piece) {
  const auto first = static_cast<PetscInt>(piece.mesh.triangles.size());
  const std::vector<std::int32_t> there = places_at_owners(communicator, piece);
  std::vector<int> triangles(static_cast<std::size_t>(piece.ranks));  // count on each rank: its points come behind them
  const int own = static_cast<int>(first);
  MPI_Allgather(&own, 1, MPI_INT, triangles.data(), 1, MPI_INT, communicator);
  std::vector<PetscInt> leaves;
  std::vector<PetscSFNode> roots;
  for (std::size_t v = 0; v < there.size(); ++v) {
    if (piece.owners[v] == piece.rank) continue;
    const int owner = to_int(piece.owners[v]);
    leaves.push_back(first + static_cast<PetscInt>(v));
    roots.push_back({owner, triangles[static_cast<std::size_t>(owner)] + there[v]});
  }
  PetscSF forest = nullptr;
  PetscCall(DMGetPointSF(plex, &forest));
  PetscCall(PetscSFSetGraph(forest, first + static_cast<PetscInt>(there.size()), static_cast<PetscInt>(leaves.size()),
                            leaves.data(), PETSC_COPY_VALUES, roots.data(), PETSC_COPY_VALUES));
  return 0;
}

inline PetscErrorCode set_coordinates(DM plex, const Mesh& mesh) {
  const auto first = static_cast<PetscInt>(mesh.triangles.size());
  const PetscInt end = first + static_cast<PetscInt>(mesh.points.size());
  PetscSection section = nullptr;
  PetscCall(DMSetCoordinateDim(plex, 2));
  PetscCall(DMGetCoordinateSection(plex, &section));
  PetscCall(PetscSectionSetNumFields(section, 1));
  PetscCall(PetscSectionSetFieldComponents(section, 0, 2));
  PetscCall(PetscSectionSetChart(section, first, end));
  for (PetscInt v = first; v < end; ++v) {
    PetscCall(PetscSectionSetDof(section, v, 2));
    PetscCall(PetscSectionSetFieldDof(section, v, 0, 2));
  }
  PetscCall(PetscSectionSetUp(section));
  Vec coordinates = nullptr;
  PetscCall(VecCreateSeq(PETSC_COMM_SELF, 2 * (end - first), &coordinates));
  PetscCall(VecSetBlockSize(coordinates, 2));
  PetscScalar* values = nullptr;
  PetscCall(VecGetArray(coordinates, &values));
  for (const Point& p : mesh.points) {
    *values++ = p.x;
    *values++ = p.y;
  }
  values -= 2 * (end - first);
  PetscCall(VecRestoreArray(coordinates, &values));
  PetscCall(DMSetCoordinatesLocal(plex, coordinates));
  PetscCall(VecDestroy(&coordinates));
  return 0;
}

/// Adds the entity to the label of its number, and to the one that is called as the number is, if it has a name.
template <class Names>
PetscErrorCode label(DM plex, const char* of_numbers, PetscInt entity, typename Names::key_type number,
                     const Names& names) {
  PetscCall(DMSetLabelValue(plex, of_numbers, entity, static_cast<PetscInt>(number)));
  if (const auto name = names.find(number); name != names.end())
    PetscCall(DMSetLabelValue(plex, name->second.c_str(), entity, static_cast<PetscInt>(number)));
  return 0;
}

/// Labels exist on all ranks, also where nothing has them.
inline PetscErrorCode create_labels(DM plex, const Names& names) {
  for (const char* name : {"Cell Sets", "Face Sets", "Vertex Sets"}) PetscCall(DMCreateLabel(plex, name));
  for (const auto& [number, name] : names.markers) PetscCall(DMCreateLabel(plex, name.c_str()));
  for (const auto& [number, name] : names.regions) PetscCall(DMCreateLabel(plex, name.c_str()));
  return 0;
}

inline PetscErrorCode set_labels(DM plex, const Mesh& mesh) {
  PetscCall(create_labels(plex, mesh.names));
  for (std::size_t t = 0; t < mesh.regions.size(); ++t)
    PetscCall(label(plex, "Cell Sets", static_cast<PetscInt>(t), mesh.regions[t], mesh.names.regions));
  const auto first = static_cast<PetscInt>(mesh.triangles.size());
  for (const Mesh::Edge& e : mesh.edges) {
    const PetscInt ends[] = {first + e.a, first + e.b}, *edge = nullptr;
    PetscInt count = 0;
    PetscCall(DMPlexGetJoin(plex, 2, ends, &count, &edge));
    if (count == 1) PetscCall(label(plex, "Face Sets", edge[0], e.marker, mesh.names.markers));
    PetscCall(DMPlexRestoreJoin(plex, 2, ends, &count, &edge));
  }
  for (std::size_t v = 0; v < mesh.point_markers.size(); ++v)
    if (mesh.point_markers[v] != 0)
      PetscCall(DMSetLabelValue(plex, "Vertex Sets", first + static_cast<PetscInt>(v), mesh.point_markers[v]));
  return 0;
}

/// Makes `plex` from the pieces of all ranks. Collective. `communicator` is the one that the pieces were made on. Cells
/// are the triangles of piece.mesh in order, and behind them come its points in order, then edges. The star forest
/// joins the points and edges that ranks share. Labels: "Cell Sets" are regions, truncated to whole numbers, "Face
/// Sets" markers of edges, "Vertex Sets" those of points but 0, and one for each name of a marker or a region.
inline PetscErrorCode to_dmplex(MPI_Comm communicator, const DistributedPiece& piece, DM* plex) {
  const Mesh& mesh = piece.mesh;
  const auto triangles = static_cast<PetscInt>(mesh.triangles.size());
  DM bare = nullptr;  // without edges
  PetscCall(DMPlexCreate(communicator, &bare));
  PetscCall(DMSetDimension(bare, 2));
  PetscCall(DMPlexSetChart(bare, 0, triangles + static_cast<PetscInt>(mesh.points.size())));
  for (PetscInt t = 0; t < triangles; ++t) PetscCall(DMPlexSetConeSize(bare, t, 3));
  PetscCall(DMSetUp(bare));
  for (PetscInt t = 0; t < triangles; ++t) {
    const auto& [a, b, c] = mesh.triangles[static_cast<std::size_t>(t)];
    const PetscInt corners[] = {triangles + a, triangles + b, triangles + c};
    PetscCall(DMPlexSetCone(bare, t, corners));
  }
  PetscCall(DMPlexSymmetrize(bare));
  PetscCall(DMPlexStratify(bare));
  PetscCall(set_star_forest(bare, communicator, piece));
  PetscCall(set_coordinates(bare, mesh));
  PetscCall(DMPlexInterpolate(bare, plex));
  PetscCall(DMDestroy(&bare));
  PetscCall(set_labels(*plex, mesh));
  return 0;
}

}  // namespace driftmesh::petsc
