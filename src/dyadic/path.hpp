#pragma once

#include <bit>
#include <cstdint>

namespace driftmesh::dyadic {

/// The name of a point or an interval on a shared edge, without coordinates.
///
/// An edge, oriented from its start to its end, is cut by midpoints only: its points form a binary tree. Heap index k
/// names an interval and, at once, that interval's midpoint: k = 1 is the whole edge and its middle, 2k and 2k + 1 are
/// the first and the second half of interval k. A point can exist only if its parent k >> 1 does. (The paper, section
/// 3.2, names the point n / 2^m by the pair (n, m); k = 2^(m-1) + (n-1)/2 is the same in one integer.)
using Path = std::uint64_t;

inline constexpr Path kWhole = 1;
/// Intervals deeper than this are not split: 2^-kMaxDepth of an edge is below the resolution of its coordinates.
inline constexpr int kMaxDepth = 60;

/// How many halvings lead from the whole edge to interval k (0 for the whole edge). Needs k >= 1.
[[nodiscard]] constexpr int depth(Path k) {
  return 63 - std::countl_zero(k);
}
[[nodiscard]] constexpr Path parent(Path k) {
  return k >> 1;
}
[[nodiscard]] constexpr Path first_half(Path k) {
  return k << 1;
}
[[nodiscard]] constexpr Path second_half(Path k) {
  return (k << 1) | 1;
}
/// Whether the step from the parent to k goes into the second half.
[[nodiscard]] constexpr bool is_second_half(Path k) {
  return (k & 1) != 0;
}
/// Which half of `ancestor` leads to k. Needs ancestor to be a proper ancestor of k.
[[nodiscard]] constexpr bool descends_second(Path ancestor, Path k) {
  return ((k >> (depth(k) - depth(ancestor) - 1)) & 1) != 0;
}
/// Whether `ancestor` lies on the way from the whole edge to k (a path is its own ancestor).
[[nodiscard]] constexpr bool is_ancestor(Path ancestor, Path k) {
  const int down = depth(k) - depth(ancestor);
  return down >= 0 && (k >> down) == ancestor;
}
/// The place of midpoint k on its edge, in units of 2^-62 of the edge: exact for every depth up to kMaxDepth.
[[nodiscard]] constexpr std::uint64_t position(Path k) {
  const int d = depth(k);
  const std::uint64_t index = k - (std::uint64_t{1} << d);  // number of the interval among those of its depth
  return (2 * index + 1) << (61 - d);
}

}  // namespace driftmesh::dyadic
