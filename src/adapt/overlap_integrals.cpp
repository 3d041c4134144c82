#include "adapt/overlap_integrals.hpp"

#include <utility>
#include <vector>

namespace driftmesh::adapt {

Overlaps::Overlaps(const Lineage::Change& change, OverlapList room) : found(std::move(room)) {
  found.overlaps.clear();
  if (change.is_the_same) return;
  IdVector<TriangleId, bool> stays(change.old_mesh.triangles.size(), false);
  for (const TriangleId from : change.same)
    if (from != kNone) stays[from] = true;
  const auto is_new = [&](TriangleId t) { return change.same[t] == kNone; };
  find_overlaps(change.old_mesh, change.new_mesh, is_new, found);
  std::erase_if(found.overlaps, [&](const Overlap& o) { return stays[o.old_triangle]; });
  correction.assign(change.old_mesh.triangles.size(), 0);
  for (const Overlap& o : found.overlaps) correction[o.old_triangle] += o.area;
  for (const TriangleId t : ids_of(change.old_mesh.triangles))
    if (correction[t] > 0) correction[t] = area_of(change.old_mesh, t) / correction[t];
}

}  // namespace driftmesh::adapt
