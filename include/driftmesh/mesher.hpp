#pragma once

#include "driftmesh/mesh.hpp"
#include "driftmesh/options.hpp"
#include "driftmesh/pslg.hpp"

namespace driftmesh {

/// A mesh of the domain that `input` describes, made in this process: in one piece, or in options.subdomains.
///
/// The input may be as users feed it: a copy is repaired first (repair() says what that means, and what it changed).
/// The mesh is constrained Delaunay, by exact predicates, and covers every segment of the repaired input. No triangle
/// is larger than the bounds on areas and sizes allow, and no angle is smaller than options.min_angle, except where
/// small angles of the input or the precision of doubles force smaller ones (docs/guarantees.md). The same input and
/// options give the same mesh, bit for bit, on every machine with IEEE arithmetic.
///
/// May be called from several threads at once. Throws InputError for an input that cannot be repaired or has no room
/// for a triangle that the bounds ask for, Error for options that are out of range or do not apply, LimitError,
/// Cancelled, and what options.size or options.progress throw.
[[nodiscard]] Mesh mesh(const Pslg& input, const MeshOptions& options = {});

}  // namespace driftmesh
