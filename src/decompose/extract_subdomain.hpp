#pragma once

#include <map>
#include <vector>

#include "decompose/decomposition.hpp"
#include "decompose/subdomain_mesh.hpp"
#include "driftmesh/id_vector.hpp"
#include "driftmesh/ids.hpp"
#include "dyadic/path.hpp"
#include "mesh/handles.hpp"

namespace driftmesh {

/// An interval of a root of one decomposition that is a root of the next one, in either direction.
struct RootInterval {
  dyadic::Path interval = dyadic::kWhole;
  GlobalRootId root{};
  friend bool operator==(const RootInterval&, const RootInterval&) = default;
};
/// For each root that becomes a chain of roots, the intervals that cover it. Roots not in it keep their number. The
/// roots of a shell can only be halved all at once, with names for the halves and for the circle between them (see
/// same_segments.cpp): else the refinement of an acute corner may not end.
using RenamedRoots = std::map<GlobalRootId, std::vector<RootInterval>>;

struct ExtractedSubdomain {
  SubdomainMesh part;
  // What each was in the mesh that the subdomain is taken from:
  IdVector<VertexId, VertexId> vertex;
  IdVector<TriangleId, TriangleId> triangle;
};

/// Subdomain `s` of the decomposition `now`, cut out of the refined mesh of a subdomain of the one before: the
/// triangles that the roots of s enclose, none of which changes. Points of the decomposition come first, ascending,
/// then all others; these and the triangles keep their order, and no slot is free. Points on roots are the same as on
/// the roots that they were part of. Linear in the size of `from`. Throws Error if a root or point of s is not in the
/// mesh, or if its roots do not enclose what they should.
[[nodiscard]] ExtractedSubdomain extract_subdomain(const SubdomainMesh& from, const RenamedRoots& renamed,
                                                   const Decomposition& now, SubdomainId s);

}  // namespace driftmesh
