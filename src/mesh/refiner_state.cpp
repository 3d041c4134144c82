#include "mesh/refiner_state.hpp"

#include <algorithm>
#include <array>

namespace driftmesh {
namespace {

bool are_below(const std::vector<std::int32_t>& handles, std::size_t count) {
  return std::all_of(handles.begin(), handles.end(),
                     [&](std::int32_t h) { return h >= 0 && static_cast<std::size_t>(h) < count; });
}

bool is_sound(const Sweep& sweep, std::size_t triangles) {
  const auto [cursor, block_end, given, added, block] = sweep.places();
  return 0 <= cursor && cursor <= block_end && block_end <= given && given <= added &&
         static_cast<std::size_t>(added) <= triangles && block >= 1 && are_below(sweep.again(), triangles);
}

/// Further counting cannot overflow.
bool is_sound(const RefineCounters& c) {
  constexpr std::int64_t kMost = std::int64_t{1} << 60;
  const std::array<std::int64_t, 5> all{c.free_points, c.segment_points, c.deleted_points, c.encroaching, c.given_up};
  return std::all_of(all.begin(), all.end(), [](std::int64_t n) { return n >= 0 && n < kMost; });
}

bool is_sound(const SkinnyBuckets& skinny, std::size_t triangles) {
  const std::vector<SkinnyBuckets::Entry> entries = skinny.entries();
  return std::all_of(entries.begin(), entries.end(), [&](const SkinnyBuckets::Entry& e) {
    return e.triangle >= 0 && static_cast<std::size_t>(e.triangle) < triangles;
  });
}

}  // namespace

RefinerState RefinerState::at_rest(const Triangulation& mesh, const QualityBounds& bounds) {
  RefinerState state;
  const auto triangles = static_cast<TriangleId>(mesh.triangles.size());
  state.stage = Stage::kDone;
  state.next_segment = static_cast<SubsegmentId>(mesh.subsegments.size());
  state.sweep = Sweep({triangles, triangles, triangles, triangles, 1}, {});
  if (bounds.size != nullptr)
    for (const Point& p : mesh.points) state.size.push_back(bounds.size->edge_length(p));
  return state;
}

std::string RefinerState::fault(const Triangulation& mesh, const QualityBounds& bounds) const {
  const std::size_t triangles = mesh.triangles.size(), subsegments = mesh.subsegments.size();
  const std::vector<SubsegmentId> kept_whole(unsplittable.begin(), unsplittable.end());
  if (stage > Stage::kDone) return "there is no such stage";
  if (next_segment < 0 || static_cast<std::size_t>(next_segment) > subsegments) return "no segment is next";
  if (!is_sound(sweep, triangles)) return "the sweep leaves the mesh";
  if (!is_sound(skinny, triangles)) return "a skinny triangle does not exist";
  if (!are_below(deferred, triangles)) return "a deferred triangle does not exist";
  if (!are_below(kept_whole, subsegments)) return "an unsplittable subsegment does not exist";
  for (const SplitPoint<RootId>& p : made)
    if (p.root < 0 || static_cast<std::size_t>(p.root) >= mesh.roots.size() || p.path == 0 ||
        dyadic::depth(p.path) > dyadic::kMaxDepth)
      return "a split point is on no root";
  if (!is_sound(counters)) return "a counter is negative or impossibly large";
  if (max_triangles > kMaxTriangles - 64) return "the limit on triangles exceeds what handles can name";
  if (bounds.size != nullptr && size.size() < mesh.points.size()) return "the size field is missing at some vertex";
  const std::size_t labels = bounds.region_max_area.size();
  if (labels > 1 && std::any_of(mesh.region.begin(), mesh.region.end(), [&](auto label) { return label >= labels; }))
    return "a region has no bound";
  return "";
}

}  // namespace driftmesh
