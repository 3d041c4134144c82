#pragma once

#include <functional>

#include "adapt/generation.hpp"
#include "adapt/move.hpp"
#include "decompose/extract_subdomain.hpp"
#include "distributed/ranks.hpp"
#include "driftmesh/ids.hpp"

namespace driftmesh::adapt {

/// The same mesh and fields under a changed decomposition: nothing moves, numbers change. `whole_of`: which present
/// subdomain each one of `now` is, or is a part of; it stays on the rank of that one. A part that is not divided, and
/// none of whose roots became a chain, keeps its mesh. `assemble`: as adapt::assemble with `now`, and with what the
/// caller knows. Throws Error, on all ranks, if `now` does not continue the present decomposition. Collective.
[[nodiscard]] Holding recast(const Held& present, const RenamedRoots& renamed, const Decomposition& now,
                             const IdVector<SubdomainId, SubdomainId>& whole_of,
                             const std::function<Generation(Parts)>& assemble, Ranks& ranks);

/// The same for meshes alone, on each rank by itself.
[[nodiscard]] Parts recast(const Parts& present, const RenamedRoots& renamed, const Decomposition& now,
                           const IdVector<SubdomainId, SubdomainId>& whole_of);

}  // namespace driftmesh::adapt
