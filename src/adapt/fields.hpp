#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "adapt/lineage.hpp"
#include "adapt/transfer.hpp"
#include "distributed/ranks.hpp"
#include "driftmesh/adaptive.hpp"
#include "driftmesh/distributed_piece.hpp"
#include "driftmesh/mesh.hpp"

namespace driftmesh::adapt {

using Fields = std::map<std::string, Field>;

/// Of the values that a field has at each place, as a caller sees them: {} for a number, {2, 2} for a matrix. None: {}
/// for one value, {n} for several.
using Shapes = std::map<std::string, std::vector<std::int64_t>>;

/// "(2, 2)".
[[nodiscard]] std::string shape_text(const std::vector<std::int64_t>& shape);

/// "points", "triangles" or "corners of triangles".
[[nodiscard]] const char* words_of(FieldPlace place);

/// Throws Error if the number of values does not suit the mesh, or what is asked for is not possible. Without places,
/// the number of components is 0: others know it.
[[nodiscard]] Field make_field(const Mesh& mesh, const std::string& name, std::vector<double> values, FieldPlace place,
                               Transfer how);

/// Throws Error unless values of this shape are so many.
void require_shape(const std::string& name, const std::vector<std::int64_t>& shape, std::size_t components);

/// Throws Error for a value that has no place in a sum, where a field keeps its integral: NaN, infinite, or so large
/// that sums would be. `piece`: of a session; at points of other ranks, their values count.
void require_summable(const std::string& name, const Field& field, const DistributedPiece* piece = nullptr);

/// Gives fields at points that ranks share the values of the points' owners on all of them. Collective.
void take_from_owners(Fields& fields, const DistributedPiece& piece, Ranks& ranks);

/// The fields on the new mesh, and what stayed of the old one. Collective.
[[nodiscard]] Fields carried(const Fields& fields, const Lineage& lineage, Stayed& stayed);

}  // namespace driftmesh::adapt
