#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "driftmesh/id_vector.hpp"
#include "driftmesh/mesh.hpp"

namespace driftmesh {

/// Where a triangle is listed. Numbers count from 0.
struct TrianglePlace {
  std::int32_t piece = kNone;  ///< kNone: the mesh is not in pieces
  std::int32_t triangle = 0;
};

/// A mesh or a part of one, and what its points and triangles are called. The mesh must outlive the object.
class NamedMesh {
 public:
  /// A whole mesh: as it numbers them.
  NamedMesh(const Mesh& mesh) : mesh_(&mesh) {}
  /// A piece: points by their numbers in the whole.
  NamedMesh(const Mesh& mesh, std::int32_t piece) : mesh_(&mesh), piece_(piece), by_number_(piece != kNone) {}
  /// A part of a mesh or of several pieces: points by their numbers, triangles by these places.
  NamedMesh(const Mesh& mesh, const std::vector<TrianglePlace>& places)
      : mesh_(&mesh), places_(&places), by_number_(true) {}

  [[nodiscard]] const Mesh& mesh() const { return *mesh_; }
  /// Also of a point that does not exist.
  [[nodiscard]] std::int64_t number(std::int32_t point) const {
    return by_number_ && to_index(point) < mesh_->numbers.size() ? mesh_->numbers[point] : point;
  }
  /// Whether numbers of points ascend.
  [[nodiscard]] bool ascending() const { return !by_number_ || std::ranges::is_sorted(mesh_->numbers); }
  [[nodiscard]] std::array<std::int64_t, 3> numbers(std::size_t triangle) const {
    const auto& [a, b, c] = mesh_->triangles[triangle];
    return {number(a), number(b), number(c)};
  }
  [[nodiscard]] TrianglePlace place(std::size_t triangle) const {
    return places_ != nullptr ? (*places_)[triangle] : TrianglePlace{piece_, static_cast<std::int32_t>(triangle)};
  }

 private:
  const Mesh* mesh_;
  const std::vector<TrianglePlace>* places_ = nullptr;
  std::int32_t piece_ = kNone;
  bool by_number_ = false;
};

// How messages name parts of a mesh.

/// "triangle 7 (1 2 3)", or "triangle 7 of piece 2 (1 2 3)"
[[nodiscard]] std::string triangle_words(const TrianglePlace& place, const std::array<std::int64_t, 3>& corners);
[[nodiscard]] std::string triangle_words(const NamedMesh& mesh, std::size_t triangle);
/// "point 4 at (0.5, 1)"
[[nodiscard]] std::string point_words(std::int64_t number, const Point& at);
[[nodiscard]] std::string point_words(const NamedMesh& mesh, std::int32_t point);
/// "edge 1-2 from (0, 0) to (1, 0)"
[[nodiscard]] std::string edge_words(const NamedMesh& mesh, std::int32_t u, std::int32_t v);
/// "(0.5, 1)", with all digits
[[nodiscard]] std::string place_words(const Point& p);

}  // namespace driftmesh
