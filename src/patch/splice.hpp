#pragma once

#include <cstdint>
#include <vector>

#include "driftmesh/mesh.hpp"
#include "patch/domain.hpp"
#include "patch/old_places.hpp"
#include "patch/part.hpp"

namespace driftmesh::patch {

/// What a part of a mesh has become, with numbers of its own: first what was made, then what is beyond it in the part.
struct NewPart {
  Mesh mesh;                               ///< points, triangles, edges, markers, regions
  std::vector<std::int32_t> old_point;     ///< of the part; -1: it is new
  std::vector<std::int32_t> old_triangle;  ///< the same
  std::size_t triangles_made = 0;          ///< in place of those that were taken, the first ones
};
/// `made`: the domain in place of the triangles that were taken.
[[nodiscard]] NewPart new_part(const Mesh& made, const Domain& domain, const Part& part, const Extent& extent,
                               const OldPlaces& old);

/// The numbers that everything has in the mesh that a new part is put into.
struct Numbers {
  std::vector<std::int32_t> points;         ///< of the new part
  std::vector<std::int32_t> triangles;      ///< of the new part, as far as they were made
  std::vector<std::int32_t> old_points;     ///< for each point of the new mesh its number in the old one; -1: it is new
  std::vector<std::int32_t> old_triangles;  ///< the same for triangles
};

/// Puts a new part in place of the old one. What stays keeps its number and its bits. New points and triangles get the
/// numbers that have become free, in ascending order, and then higher ones. Where numbers are left, the last points or
/// triangles get them, so that few others change. Point data are not looked at.
Numbers splice(Mesh& mesh, const Part& part, const Extent& extent, const NewPart& made);

}  // namespace driftmesh::patch
