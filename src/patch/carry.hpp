#pragma once

#include <cstdint>
#include <vector>

#include "adapt/fields.hpp"
#include "mesh/triangulation.hpp"
#include "patch/part.hpp"
#include "patch/splice.hpp"

namespace driftmesh::patch {

/// Gives the fields of a mesh the values that they have once a part of it is new: beyond the part they keep theirs.
/// What is interpolated at triangles is the value of the old triangle in which the center of the new one lies, or of
/// that nearest to it. `before`: the old part.
void carry(std::vector<adapt::Field>& fields, const Part& part, const NewPart& made, Triangulation before,
           const Numbers& numbers, std::int32_t threads);

}  // namespace driftmesh::patch
