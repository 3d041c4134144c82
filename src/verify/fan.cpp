#include "verify/fan.hpp"

#include <algorithm>

#include "driftmesh/id_vector.hpp"

namespace driftmesh {

void Fan::gather(const Mesh& mesh, std::span<const std::uint32_t> corners) {
  spokes_.clear();
  for (const std::uint32_t corner : corners) {
    const std::uint32_t t = corner / 3, k = corner % 3;
    const auto& triangle = mesh.triangles[t];
    spokes_.push_back({triangle[k == 2 ? 0 : k + 1], triangle[k == 0 ? 2 : k - 1], static_cast<std::int32_t>(t)});
  }
  std::sort(spokes_.begin(), spokes_.end(), [](const Spoke& a, const Spoke& b) { return a.next < b.next; });
  ccw_.assign(spokes_.size(), kNone);
  cw_.assign(spokes_.size(), kNone);
  for (std::size_t i = 0; i < spokes_.size(); ++i) {
    const auto found = std::lower_bound(spokes_.begin(), spokes_.end(), spokes_[i].prev,
                                        [](const Spoke& spoke, std::int32_t next) { return spoke.next < next; });
    if (found == spokes_.end() || found->next != spokes_[i].prev) continue;
    const std::int32_t j = static_cast<std::int32_t>(found - spokes_.begin());
    ccw_[i] = j;
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
