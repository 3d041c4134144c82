#include "geometry/box_tree.hpp"

#include "base/narrow.hpp"
#include "geometry/hilbert.hpp"

namespace driftmesh {
namespace {

/// Indices of boxes, sorted by the place of their centers on a Hilbert curve.
std::vector<std::int32_t> sorted_along_curve(const std::vector<Box>& boxes) {
  Box all;
  for (const Box& box : boxes) all.extend(box);
  const HilbertOrder order(all.low, all.high);
  struct Place {
    std::uint64_t on_curve;
    std::int32_t item;
  };
  std::vector<Place> places(boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i)
    places[i] = {order.index(boxes[i].center()), narrow<std::int32_t>(i, "number of boxes")};
  std::sort(places.begin(), places.end(), [](const Place& a, const Place& b) {
    return a.on_curve != b.on_curve ? a.on_curve < b.on_curve : a.item < b.item;
  });
  std::vector<std::int32_t> items(boxes.size());
  std::transform(places.begin(), places.end(), items.begin(), [](const Place& place) { return place.item; });
  return items;
}

}  // namespace

BoxTree::BoxTree(const std::vector<Box>& boxes) {
  if (boxes.empty()) return;
  items_ = sorted_along_curve(boxes);
  std::vector<Box> level(boxes.size());
  std::transform(items_.begin(), items_.end(), level.begin(),
                 [&](std::int32_t item) { return boxes[static_cast<std::size_t>(item)]; });
  while (level.size() > kChildren) {
    std::vector<Box> above((level.size() + kChildren - 1) / kChildren);
    for (std::size_t i = 0; i < level.size(); ++i) above[i / kChildren].extend(level[i]);
    levels_.push_back(std::move(level));
    level = std::move(above);
  }
  levels_.push_back(std::move(level));
}

}  // namespace driftmesh
