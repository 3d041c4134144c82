#pragma once

#include "driftmesh/mesh.hpp"
#include "driftmesh/options.hpp"
#include "driftmesh/pslg.hpp"

namespace driftmesh {

/// A mesh of the domain that `input` describes, made in this process by options.threads: in one piece, or in
/// options.subdomains.
///
/// The input need not be clean: a copy of it is repaired first, see repair().
/// The mesh is constrained Delaunay, by exact predicates, and covers every segment of the repaired input. No triangle
/// exceeds the bounds on area and size, and no angle is smaller than options.min_angle, except where
/// small angles of the input or the precision of doubles force smaller ones (docs/guarantees.md). The same input and
/// options give the same mesh, bit for bit, on every machine with IEEE arithmetic; but what is computed by sin, exp and
/// their like, as generated domains and sizes by expressions may be, can differ with the C library.
///
/// May be called from several threads concurrently. Throws InputError for an input that cannot be repaired or has no
/// room for a triangle that the bounds require, Error for options that are out of range or do not apply, LimitError,
/// Cancelled, and what options.size or options.progress throw.
///
/// \code
/// const auto size = [](const driftmesh::Point& p) { return 0.05 + 0.1 * std::hypot(p.x, p.y); };
/// const driftmesh::Mesh mesh = driftmesh::mesh(driftmesh::generate("cylinder-flow"), {.min_angle = 30, .size = size});
/// std::cout << mesh.triangles.size() << " triangles, small ones at the cylinder\n";
/// \endcode
[[nodiscard]] Mesh mesh(const Pslg& input, const MeshOptions& options = {});

}  // namespace driftmesh
