#include "geometry/box_tree.hpp"

#include "base/narrow.hpp"
#include "geometry/hilbert.hpp"

namespace driftmesh {
namespace {

constexpr std::ptrdiff_t kLongRun = 64;

struct Place {
  std::uint64_t on_curve;
  std::int32_t item;
};
using Places = std::vector<Place>::iterator;

/// Sorts by the position of the boxes' centers along a Hilbert curve. Centers that share a cell of the curve (all but
/// one may, if there is a distant outlier) are sorted along a finer curve, so the tree is good for any distribution.
void sort_along_curve(Places begin, Places end, const std::vector<Box>& boxes) {
  const auto center = [&](const Place& place) { return boxes[place.item].center(); };
  Box all;
  for (Places i = begin; i != end; ++i) all.extend(center(*i));
  if (all.low == all.high) return;
  const HilbertOrder order(all.low, all.high);
  for (Places i = begin; i != end; ++i) i->on_curve = order.index(center(*i));
  std::sort(begin, end, [](const Place& a, const Place& b) {
    return a.on_curve != b.on_curve ? a.on_curve < b.on_curve : a.item < b.item;
  });
  for (Places run = begin; run != end;) {
    const Places next = std::find_if(run, end, [run](const Place& place) { return place.on_curve != run->on_curve; });
    if (next - run > kLongRun && next - run < end - begin) sort_along_curve(run, next, boxes);
    run = next;
  }
}

/// Indices of boxes, in the order of the curve.
std::vector<std::int32_t> sorted_along_curve(const std::vector<Box>& boxes) {
  std::vector<Place> places(boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) places[i] = {0, narrow<std::int32_t>(i, "number of boxes")};
  sort_along_curve(places.begin(), places.end(), boxes);
  std::vector<std::int32_t> items(boxes.size());
  std::transform(places.begin(), places.end(), items.begin(), [](const Place& place) { return place.item; });
  return items;
}

}  // namespace

BoxTree::BoxTree(const std::vector<Box>& boxes) {
  if (boxes.empty()) return;
  items_ = sorted_along_curve(boxes);
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

BoxTree::Least BoxTree::least(const std::vector<double>& values) const {
  Least all;
  for (std::size_t level = 0; level < levels_.size(); ++level) {
    std::vector<double>& here = all.emplace_back(levels_[level].size(), std::numeric_limits<double>::infinity());
    if (level == 0)
      std::transform(items_.begin(), items_.end(), here.begin(), [&](std::int32_t item) { return values[item]; });
    else
      for (std::size_t i = 0; i < all[level - 1].size(); ++i)
        here[i / kChildren] = std::min(here[i / kChildren], all[level - 1][i]);
  }
  return all;
}

}  // namespace driftmesh
