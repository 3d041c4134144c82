#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "driftmesh/mesh.hpp"

namespace driftmesh {

/// The corners at each point of a mesh, found by counting: corner 3 t + k is corner k of triangle t.
/// The checks use no other adjacency. 14 bytes per triangle.
class CornerTable {
 public:
  /// Every index of `mesh` is valid. Throws LimitError above 1.4 billion triangles.
  explicit CornerTable(const Mesh& mesh);

  [[nodiscard]] std::span<const std::uint32_t> around(std::int32_t point) const {
    return {corners_.data() + first_[point], first_[point + 1] - first_[point]};
  }
  [[nodiscard]] bool used(std::int32_t point) const { return !around(point).empty(); }

 private:
  std::vector<std::uint32_t> first_;
  std::vector<std::uint32_t> corners_;
};

}  // namespace driftmesh
