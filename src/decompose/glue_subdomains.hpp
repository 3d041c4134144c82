#pragma once

#include <cstdint>
#include <span>

#include "decompose/subdomain_mesh.hpp"
#include "decompose/with_joins.hpp"
#include "driftmesh/id_vector.hpp"
#include "driftmesh/ids.hpp"
#include "mesh/handles.hpp"

namespace driftmesh {

/// A vertex or triangle of one of several meshes.
template <class Id>
struct InMesh {
  std::int32_t mesh = kNone;
  Id id = kNone;
};

struct GluedSubdomain {
  SubdomainMesh part;
  // What each is in the meshes that were glued; a vertex on a border between them, in the first that has it:
  IdVector<VertexId, InMesh<VertexId>> vertex;
  IdVector<TriangleId, InMesh<TriangleId>> triangle;
};

/// The inverse of extract_subdomain: subdomain `s` of the new decomposition, put together from the refined meshes of
/// all subdomains that it has been joined from, ascending. Points of the decomposition come first, ascending; then all
/// others, and triangles, in the order of meshes, and no slot is free. No triangle changes: edges on separators that
/// are gone are edges like others now, which need not be Delaunay. So the mesh is good for all that reads it, but is
/// not to be refined.
[[nodiscard]] GluedSubdomain glue_subdomains(std::span<const SubdomainMesh* const> meshes,
                                             const JoinedSubdomains& joined, SubdomainId s);

/// The mesh of a subdomain that has only been numbered anew; vertices and triangles keep their numbers.
[[nodiscard]] SubdomainMesh renamed_subdomain(const SubdomainMesh& mesh, const JoinedSubdomains& joined);

/// What a change of numbers does to the mesh of a subdomain that is joined with no other one.
enum class Renaming : std::uint8_t { kNothing, kNumbers, kRoots };
/// kRoots: some of its roots have become one, which takes glue_subdomains().
[[nodiscard]] Renaming renaming_of(const SubdomainMesh& mesh, const JoinedSubdomains& joined);

}  // namespace driftmesh
