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
  static constexpr std::size_t kUsual = 8;  ///< triangles, for which loops of that fixed length are fastest

  /// Orders the triangles of `corners`, the entries of a CornerTable for this vertex. False if they form no single
  /// closed ring, or are too many.
  bool gather(const Mesh& mesh, std::int32_t hub, std::span<const std::uint32_t> corners);

  [[nodiscard]] std::size_t size() const { return size_; }
  /// The neighbors of the vertex counterclockwise, from 1 to size(). The last comes before them, too, and the first
  /// after them; beyond that, up to the next of kUsual + 1 and kMost + 1, is the vertex itself.
  [[nodiscard]] std::int32_t neighbor(std::size_t i) const { return neighbor_[i]; }
  /// The triangle between neighbors i and i + 1, from 0 to size().
  [[nodiscard]] std::int32_t triangle(std::size_t i) const { return triangle_[i]; }

 private:
  template <std::size_t Most>
  [[nodiscard]] bool link();
  template <std::size_t Most>
  [[nodiscard]] bool walk(std::int32_t hub);

  struct Spoke {
    std::int32_t next, triangle;
  };
  std::size_t size_ = 0;
  // Triangles as seen from the vertex: it, next, prev counterclockwise.
  std::array<Spoke, kMost> spokes_;
  std::array<std::int32_t, kMost> prev_;
  std::array<std::int32_t, kMost> follower_;  // the only triangle whose `next` is `prev` of this one
  std::array<std::int32_t, kMost + 2> neighbor_, triangle_;
};

}  // namespace driftmesh
