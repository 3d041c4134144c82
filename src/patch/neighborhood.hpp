#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "driftmesh/mesh.hpp"

namespace driftmesh::patch {

/// The triangles of a mesh that are taken out of it: some, and layers of others around them. The mesh must outlive it.
class Neighborhood {
 public:
  /// `inside`: one for each triangle.
  Neighborhood(const Mesh& mesh, const std::vector<bool>& inside);

  /// Takes the triangles that share a point with one that is taken, so many times.
  void grow(int layers);
  /// The same around some points. Returns whether a triangle was added.
  bool grow_around(std::span<const std::int32_t> points, int layers);

  [[nodiscard]] bool takes(std::int32_t triangle) const { return taken_[static_cast<std::size_t>(triangle)] != 0; }
  /// Those that are taken and those that share a point with one, ascending.
  [[nodiscard]] std::vector<std::int32_t> with_rim() const;

 private:
  [[nodiscard]] bool touches(std::size_t triangle, const std::vector<std::uint8_t>& marked) const;
  [[nodiscard]] std::vector<std::uint8_t> points_of_taken() const;
  bool take_at(std::vector<std::uint8_t> marked, int layers);

  const Mesh& mesh_;
  std::vector<std::uint8_t> taken_;
};

}  // namespace driftmesh::patch
