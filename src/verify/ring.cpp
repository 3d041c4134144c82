#include "verify/ring.hpp"

#include "driftmesh/id_vector.hpp"

namespace driftmesh {
namespace {

constexpr std::size_t kUsual = 8;  // triangles: for as many, all are compared with all faster than one is searched

}  // namespace

bool Ring::gather(const Mesh& mesh, std::span<const std::uint32_t> corners) {
  size_ = corners.size();
  if (size_ < 3 || size_ > kMost) return false;
  for (std::size_t i = 0; i < size_; ++i) {
    const std::uint32_t t = corners[i] / 3, k = corners[i] % 3;
    const auto& triangle = mesh.triangles[t];
    next_[i] = triangle[k == 2 ? 0 : k + 1];
    prev_[i] = triangle[k == 0 ? 2 : k - 1];
    triangle_[i] = static_cast<std::int32_t>(t);
  }
  return (size_ <= kUsual ? link<kUsual>() : link<kMost>()) && walk();
}

// Without branches: the number of followers, and the sum of their numbers, which is that of the only one.
template <std::size_t Most>
bool Ring::link() {
  for (std::size_t i = size_; i < Most; ++i) next_[i] = kNone;
  bool one_each = true;
  for (std::size_t i = 0; i < size_; ++i) {
    std::int32_t count = 0, sum = 0;
    for (std::size_t j = 0; j < Most; ++j) {
      const std::int32_t follows = next_[j] == prev_[i] ? 1 : 0;
      count += follows;
      sum += follows * static_cast<std::int32_t>(j);
    }
    one_each &= count == 1;
    follower_[i] = sum;
  }
  return one_each;
}

// If the way from follower to follower returns to the first triangle when it has passed all of them, each follows
// exactly one other: they are a ring, and no edge has two triangles on one side.
bool Ring::walk() {
  std::int32_t at = 0;
  for (std::size_t i = 0; i < size_; ++i) {
    if (at == 0 && i > 0) return false;
    order_[i] = at;
    at = follower_[at];
  }
  return at == 0;
}

}  // namespace driftmesh
