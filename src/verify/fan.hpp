#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "driftmesh/mesh.hpp"

namespace driftmesh {

/// One triangle seen from one of its corners, the hub: hub, next, prev counterclockwise.
struct Spoke {
  std::int32_t next = 0;
  std::int32_t prev = 0;
  std::int32_t triangle = 0;
};

/// The triangles around one point, linked across the edges that they share. The object is reused from point to point.
class Fan {
 public:
  /// Gathers the triangles of `corners` (entries of a CornerTable) and sorts them by `next`.
  void gather(const Mesh& mesh, std::span<const std::uint32_t> corners);

  [[nodiscard]] std::span<const Spoke> spokes() const { return spokes_; }
  /// The spoke across the edge from the hub to prev: the neighbor in counterclockwise direction, or kNone.
  [[nodiscard]] std::int32_t across_prev(std::size_t i) const { return ccw_[i]; }
  /// The spoke across the edge from the hub to next, or kNone.
  [[nodiscard]] std::int32_t across_next(std::size_t i) const { return cw_[i]; }

  /// How many closed rings and how many open sectors the triangles form.
  struct Shape {
    std::int32_t rings = 0;
    std::int32_t sectors = 0;
  };
  [[nodiscard]] Shape shape();

 private:
  std::vector<Spoke> spokes_;
  std::vector<std::int32_t> ccw_, cw_;
  std::vector<char> seen_;
};

}  // namespace driftmesh
