#include "verify/ring.hpp"

namespace driftmesh {

bool Ring::gather(const Mesh& mesh, std::int32_t hub, std::span<const std::uint32_t> corners) {
  size_ = corners.size();
  if (size_ < 3 || size_ > kMost) return false;
  for (std::size_t i = 0; i < size_; ++i) {
    const std::uint32_t t = corners[i] / 3, k = corners[i] % 3;
    const auto& triangle = mesh.triangles[t];
    spokes_[i] = {triangle[k == 2 ? 0 : k + 1], static_cast<std::int32_t>(t)};
    prev_[i] = triangle[k == 0 ? 2 : k - 1];
  }
  return size_ <= kUsual ? link<kUsual>() && walk<kUsual>(hub) : link<kMost>() && walk<kMost>(hub);
}

// Without branches: all are compared with all. Followers are counted in units that their numbers do not reach.
template <std::size_t Most>
bool Ring::link() {
  constexpr std::int32_t kOne = 64;
  std::array<std::int32_t, Most> found{};
  for (std::size_t j = 0; j < size_; ++j)
    for (std::size_t i = 0; i < Most; ++i)
      found[i] += spokes_[j].next == prev_[i] ? kOne + static_cast<std::int32_t>(j) : 0;
  bool one_each = true;
  for (std::size_t i = 0; i < size_; ++i) {
    one_each &= found[i] / kOne == 1;
    follower_[i] = found[i] % kOne;
  }
  return one_each;
}

// If the way from follower to follower returns to the first triangle when it has passed all of them, each follows
// exactly one other: they are a ring, and no edge has two triangles on one side.
template <std::size_t Most>
bool Ring::walk(std::int32_t hub) {
  for (std::size_t i = size_ + 2; i < Most + 2; ++i) neighbor_[i] = hub;
  std::int32_t at = 0;
  for (std::size_t i = 1; i <= size_; ++i) {
    if (at == 0 && i > 1) return false;
    neighbor_[i] = spokes_[at].next;
    triangle_[i] = spokes_[at].triangle;
    at = follower_[at];
  }
  neighbor_[0] = neighbor_[size_];
  triangle_[0] = triangle_[size_];
  neighbor_[size_ + 1] = neighbor_[1];
  return at == 0;
}

}  // namespace driftmesh
