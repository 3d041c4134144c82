#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "driftmesh/pslg.hpp"
#include "geometry/box_tree.hpp"

namespace driftmesh {

/// The outer border of an area between segments.
struct EnclosingRing {
  double area = 0;
  double length = 0;
};

/// Finds what encloses points among the segments of a planar graph, as repair() leaves it.
class EnclosingRings {
 public:
  /// `pslg` must outlive it.
  explicit EnclosingRings(const Pslg& pslg);

  /// Around `p`, which lies on no segment; empty if nothing encloses it.
  [[nodiscard]] std::optional<EnclosingRing> around(const Point& p) const;

 private:
  // A half-edge is 2 * segment for the way from a to b, 2 * segment + 1 for that from b to a.
  struct Walk {
    double twice_area = 0;
    double length = 0;
    std::int32_t rightmost = 0;
  };
  [[nodiscard]] std::int32_t tail(std::int32_t half) const;
  [[nodiscard]] const Point& at(std::int32_t half) const { return pslg_.points[static_cast<std::size_t>(tail(half))]; }
  [[nodiscard]] std::span<const std::int32_t> leaving(std::int32_t vertex) const;
  [[nodiscard]] std::int32_t next(std::int32_t half) const;
  [[nodiscard]] std::int32_t to_the_right_of(const Point& p, std::int32_t beside) const;
  [[nodiscard]] Walk walk(std::int32_t first) const;

  const Pslg& pslg_;
  BoxTree tree_;
  Box box_;
  std::vector<std::int32_t> first_;    // for each vertex, where its part of leaving_ begins
  std::vector<std::int32_t> leaving_;  // half-edges by their tails, counterclockwise
};

}  // namespace driftmesh
