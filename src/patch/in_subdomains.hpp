#pragma once

#include <cstdint>
#include <span>

#include "driftmesh/mesh.hpp"
#include "driftmesh/pslg.hpp"
#include "driftmesh/size_field.hpp"
#include "mesh/bounds.hpp"
#include "mesh/triangulation.hpp"

namespace driftmesh::patch {

/// Refines a domain, triangulated and its corners prepared, in subdomains on threads of this process. The mesh does not
/// depend on their number. `sizes`: the same size field for each thread, an object of its own, in place of that of the
/// bounds. `pslg`: what the domain was made from. Throws LimitError above so many triangles.
[[nodiscard]] Mesh refine_in_subdomains(const Triangulation& domain, const Pslg& pslg, const QualityBounds& bounds,
                                        std::span<const SizeField* const> sizes, double forecast,
                                        std::int64_t most_triangles);

/// That lengths ask for more than so many triangles.
[[noreturn]] void refuse_many(std::int64_t most_triangles);

}  // namespace driftmesh::patch
