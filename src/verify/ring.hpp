#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "driftmesh/mesh.hpp"

namespace driftmesh {

/// The triangles around an inner vertex in counterclockwise order. The object is reused from vertex to vertex.
class Ring {
 public:
  static constexpr std::size_t kMost = 32;  ///< triangles

  /// Orders the triangles of `corners` (entries of a CornerTable). False if they form no single closed ring, or are too
  /// many.
  bool gather(const Mesh& mesh, std::span<const std::uint32_t> corners);

  [[nodiscard]] std::size_t size() const { return size_; }
  /// The neighbors of the vertex counterclockwise.
  [[nodiscard]] std::int32_t neighbor(std::size_t i) const { return next_[order_[i]]; }
  /// The triangle between neighbors i and i + 1.
  [[nodiscard]] std::int32_t triangle(std::size_t i) const { return triangle_[order_[i]]; }

 private:
  template <std::size_t Most>
  [[nodiscard]] bool link();
  [[nodiscard]] bool walk();

  std::size_t size_ = 0;
  // Triangles as seen from the vertex: it, next, prev counterclockwise.
  std::array<std::int32_t, kMost> next_, prev_, triangle_;
  std::array<std::int32_t, kMost> follower_;  // the one triangle whose `next` is `prev` of this one
  std::array<std::int32_t, kMost> order_;
};

}  // namespace driftmesh
