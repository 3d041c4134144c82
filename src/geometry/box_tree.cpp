#include "geometry/box_tree.hpp"

#include "base/narrow.hpp"
#include "geometry/hilbert_sort.hpp"
#include "geometry/triangle_geometry.hpp"

namespace driftmesh {
namespace {

constexpr std::size_t kLongRun = 64;

/// Sorts by the position of the boxes' centers along a Hilbert curve. Centers that share a cell of the curve (all but
/// one may, if there is a distant outlier) are sorted along a finer curve, so the tree is good for any distribution.
std::vector<std::int32_t> sorted_along_curve(std::vector<std::int32_t> items, const std::vector<Box>& boxes) {
  const auto center = [&](std::int32_t item) { return boxes[item].center(); };
  Box all;
  for (const std::int32_t item : items) all.extend(center(item));
  if (all.low == all.high) return items;
  const HilbertOrder order(all.low, all.high);
  AlongCurve<std::int32_t> places;
  places.reserve(items.size());
  for (const std::int32_t item : items) places.emplace_back(order.index(center(item)), item);
  sort_along_curve(places);
  std::transform(places.begin(), places.end(), items.begin(), [](const auto& place) { return place.second; });
  for (std::size_t run = 0; run < places.size();) {
    std::size_t next = run + 1;
    while (next < places.size() && places[next].first == places[run].first) ++next;
    if (next - run > kLongRun && next - run < places.size()) {
      const auto begin = items.begin() + run;
      std::ranges::copy(sorted_along_curve({begin, items.begin() + next}, boxes), begin);
    }
    run = next;
  }
  return items;
}

std::vector<std::int32_t> all_items(const std::vector<Box>& boxes) {
  std::vector<std::int32_t> items(boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) items[i] = narrow<std::int32_t>(i, "number of boxes");
  return items;
}

}  // namespace

BoxTree::BoxTree(const std::vector<Box>& boxes) {
  if (boxes.empty()) return;
  items_ = sorted_along_curve(all_items(boxes), boxes);
  std::vector<Box> level(boxes.size());
  std::transform(items_.begin(), items_.end(), level.begin(), [&](std::int32_t item) { return boxes[item]; });
  while (level.size() > kChildren) {
    std::vector<Box> above((level.size() + kChildren - 1) / kChildren);
    for (std::size_t i = 0; i < level.size(); ++i) above[i / kChildren].extend(level[i]);
    levels_.push_back(std::move(level));
    level = std::move(above);
  }
  levels_.push_back(std::move(level));
}

std::int32_t BoxTree::beside(const Point& p) const {
  std::size_t begin = 0, end = levels_.back().size(), found = 0;
  for (std::size_t level = levels_.size(); level-- > 0;) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = begin; i < end; ++i) {
      const double here = driftmesh::squared_distance(levels_[level][i].center(), p);
      if (i == begin || here < least) {
        least = here;
        found = i;
      }
    }
    if (level == 0) break;
    begin = kChildren * found;
    end = children_end(level, found);
  }
  return items_[found];
}

}  // namespace driftmesh
