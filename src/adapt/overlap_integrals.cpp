#include "adapt/overlap_integrals.hpp"

#include <utility>
#include <vector>

namespace driftmesh::adapt {

namespace {

constexpr std::size_t kAtOnce = 500'000;  // overlaps: some fifty megabytes

}  // namespace

Overlaps::Overlaps(const Lineage::Change& change, OverlapList room) : found(std::move(room)) {
  found.overlaps.clear();
  if (change.is_the_same) return;
  stays_.assign(change.old_mesh.triangles.size(), false);
  for (const TriangleId from : change.descent.same)
    if (from != kNone) stays_[from] = true;
  correction.assign(change.old_mesh.triangles.size(), 0);
  const auto is_new = [&](TriangleId t) { return !change.stays(t); };
  OverlapFinder finder(change.old_mesh, change.new_mesh, is_new);
  for (; find(finder); ++left_)
    for (const Overlap& o : found.overlaps) correction[o.old_triangle] += o.area;
  if (left_ > 1) again_.emplace(change.old_mesh, change.new_mesh, is_new);
  for (const TriangleId t : ids_of(change.old_mesh.triangles))
    if (correction[t] > 0) correction[t] = area_of(change.old_mesh, t) / correction[t];
}

bool Overlaps::find(OverlapFinder& finder) {
  if (!finder.find(kAtOnce, found)) return false;
  std::erase_if(found.overlaps, [&](const Overlap& o) { return stays_[o.old_triangle]; });
  return true;
}

bool Overlaps::next() {
  if (left_ == 0) return false;
  --left_;
  return !again_ || find(*again_);
}

}  // namespace driftmesh::adapt
