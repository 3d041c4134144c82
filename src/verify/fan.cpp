#include "verify/fan.hpp"

#include <algorithm>
#include <array>

#include "driftmesh/id_vector.hpp"

namespace driftmesh {
namespace {

constexpr std::size_t kSmall =
    16;  // spokes that are compared all with all, without branches, faster than they are searched

/// How many of the spokes, sorted by `next`, come before this one.
std::size_t count_before(std::span<const Spoke> spokes, std::int32_t next) {
  if (spokes.size() > kSmall) return std::ranges::lower_bound(spokes, next, {}, &Spoke::next) - spokes.begin();
  std::size_t before = 0;
  for (const Spoke& spoke : spokes) before += spoke.next < next ? 1 : 0;
  return before;
}

/// By `next`.
void sort_spokes(std::span<Spoke> spokes) {
  if (spokes.size() > kSmall) {
    std::ranges::sort(spokes, {}, &Spoke::next);
    return;
  }
  std::array<Spoke, kSmall> unsorted;
  std::ranges::copy(spokes, unsorted.begin());
  for (std::size_t i = 0; i < spokes.size(); ++i) {
    std::size_t before = 0;
    for (std::size_t k = 0; k < spokes.size(); ++k)
      before += unsorted[k].next < unsorted[i].next + (k < i ? 1 : 0) ? 1 : 0;
    spokes[before] = unsorted[i];
  }
}

}  // namespace

void Fan::gather(const Mesh& mesh, std::span<const std::uint32_t> corners) {
  spokes_.clear();
  for (const std::uint32_t corner : corners) {
    const std::uint32_t t = corner / 3, k = corner % 3;
    const auto& triangle = mesh.triangles[t];
    spokes_.push_back({triangle[k == 2 ? 0 : k + 1], triangle[k == 0 ? 2 : k - 1], static_cast<std::int32_t>(t)});
  }
  sort_spokes(spokes_);
  ccw_.assign(spokes_.size(), kNone);
  cw_.assign(spokes_.size(), kNone);
  for (std::size_t i = 0; i < spokes_.size(); ++i) {
    const std::size_t j = count_before(spokes_, spokes_[i].prev);
    if (j == spokes_.size() || spokes_[j].next != spokes_[i].prev) continue;
    ccw_[i] = static_cast<std::int32_t>(j);
    cw_[j] = static_cast<std::int32_t>(i);
  }
}

Fan::Shape Fan::shape() {
  Shape shape;
  seen_.assign(spokes_.size(), 0);
  const auto follow = [&](std::size_t start) {
    for (auto i = static_cast<std::int32_t>(start); i != kNone && !seen_[i]; i = ccw_[i]) seen_[i] = 1;
  };
  for (std::size_t i = 0; i < spokes_.size(); ++i)
    if (cw_[i] == kNone) ++shape.sectors, follow(i);
  for (std::size_t i = 0; i < spokes_.size(); ++i)
    if (!seen_[i]) ++shape.rings, follow(i);
  return shape;
}

}  // namespace driftmesh
