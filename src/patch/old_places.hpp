#pragma once

#include <array>
#include <cstdint>
#include <unordered_map>

#include "driftmesh/mesh.hpp"
#include "driftmesh/point.hpp"

namespace driftmesh::patch {

/// Finds points and triangles of a mesh by where they are, bit for bit.
class OldPlaces {
 public:
  explicit OldPlaces(const Mesh& mesh);

  /// The number of the point that is exactly there; -1: none is.
  [[nodiscard]] std::int32_t point_at(const Point& p) const;
  /// The number of the triangle with these points, in any order; -1: there is none.
  [[nodiscard]] std::int32_t triangle_of(std::array<std::int32_t, 3> points) const;

 private:
  struct Hash {
    [[nodiscard]] std::size_t operator()(const std::array<std::uint64_t, 2>& key) const;
    [[nodiscard]] std::size_t operator()(const std::array<std::int32_t, 3>& key) const;
  };
  std::unordered_map<std::array<std::uint64_t, 2>, std::int32_t, Hash> points_;
  std::unordered_map<std::array<std::int32_t, 3>, std::int32_t, Hash> triangles_;
};

}  // namespace driftmesh::patch
