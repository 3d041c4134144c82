#include "mesh/refiner_state.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace driftmesh {
namespace {

/// Whether all handles refer to elements of `array`.
template <class Handles, class Array>
bool exist(const Handles& handles, const Array& array) {
  return std::all_of(handles.begin(), handles.end(), [&](auto handle) { return array.has(handle); });
}

bool is_sound(const Sweep& sweep, const Triangulation& mesh) {
  if (sweep.places() == Sweep::kEnded) return exist(sweep.again(), mesh.triangles);
  const auto [cursor, block_end, given, added, block] = sweep.places();
  return 0 <= cursor && cursor <= block_end && block_end <= given && given <= added &&
         std::cmp_less_equal(added, mesh.triangles.size()) && block >= 1 && exist(sweep.again(), mesh.triangles);
}

/// Leaves room so that further counting cannot overflow.
bool is_sound(const RefineCounters& c) {
  constexpr std::int64_t kMost = std::int64_t{1} << 60;
  const std::array<std::int64_t, 5> all{c.free_points, c.segment_points, c.deleted_points, c.encroaching, c.given_up};
  return std::all_of(all.begin(), all.end(), [](std::int64_t n) { return n >= 0 && n < kMost; });
}

bool is_sound(const SkinnyBuckets& skinny, const Triangulation& mesh) {
  const std::vector<SkinnyBuckets::Entry> entries = skinny.entries();
  return std::all_of(entries.begin(), entries.end(), [&](const auto& e) { return mesh.triangles.has(e.triangle); });
}

}  // namespace

RefinerState RefinerState::at_start(const Triangulation& mesh, const SizeBounds& sizes) {
  RefinerState state;
  if (sizes.by_place())
    for (const VertexId v : ids_of(mesh.points))
      state.size.push_back(mesh.origin[v] == kDeleted ? kNoBound : sizes.length_at(mesh.points[v]));
  return state;
}

RefinerState RefinerState::at_rest(const Triangulation& mesh, const SizeBounds& sizes) {
  RefinerState state = at_start(mesh, sizes);
  state.stage = Stage::kDone;
  state.next_segment = mesh.subsegments.next_id();
  state.sweep.end();
  return state;
}

std::string RefinerState::fault(const Triangulation& mesh, const SizeBounds& sizes) const {
  if (stage > Stage::kDone) return "there is no such stage";
  if (!mesh.subsegments.has(next_segment) && next_segment != mesh.subsegments.next_id())
    return "the next segment does not exist";
  if (!is_sound(sweep, mesh)) return "the sweep leaves the mesh";
  if (!is_sound(skinny, mesh)) return "a skinny triangle does not exist";
  if (!exist(deferred, mesh.triangles)) return "a deferred triangle does not exist";
  if (!exist(unsplittable, mesh.subsegments)) return "an unsplittable subsegment does not exist";
  for (const SplitPoint<RootId>& p : made)
    if (!mesh.roots.has(p.root) || p.path == 0 || dyadic::depth(p.path) > dyadic::kMaxDepth)
      return "a split point is on no root";
  if (!is_sound(counters)) return "a counter is negative or impossibly large";
  if (max_triangles > kMostRefined) return "the limit on triangles exceeds what handles can name";
  if (sizes.by_place() && size.size() < mesh.points.size()) return "the size field is missing at some vertex";
  const std::size_t labels = sizes.regions();
  if (labels > 1 && std::any_of(mesh.region.begin(), mesh.region.end(), [&](auto label) { return label >= labels; }))
    return "a region has no bound";
  return "";
}

}  // namespace driftmesh
