#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "driftmesh/id_vector.hpp"
#include "driftmesh/mesh.hpp"

namespace driftmesh {

/// The constrained subsegments of a mesh, indexed by both ends, and the triangles on their two sides.
class Subsegments {
 public:
  /// Every index of `edges` is valid.
  Subsegments(std::size_t point_count, std::vector<Mesh::Edge> edges);

  [[nodiscard]] std::size_t size() const { return edges_.size(); }
  [[nodiscard]] IdRange<std::int32_t> ids() const { return first_ids<std::int32_t>(edges_.size()); }
  [[nodiscard]] const Mesh::Edge& operator[](std::int32_t s) const { return edges_[s]; }
  /// Numbers of the subsegments that end at `point`.
  [[nodiscard]] std::span<const std::int32_t> at(std::int32_t point) const {
    return std::span(by_end_).subspan(first_[point], first_[point + 1] - first_[point]);
  }
  /// The number of the subsegment between two points, or kNone. Of a duplicate, the first.
  [[nodiscard]] std::int32_t find(std::int32_t u, std::int32_t v) const;
  [[nodiscard]] std::int32_t other_end(std::int32_t s, std::int32_t point) const {
    const Mesh::Edge& edge = (*this)[s];
    return edge.a == point ? edge.b : edge.a;
  }

  /// The triangle on the left and on the right as seen from `from` to the other end; kNone where there is none.
  [[nodiscard]] std::int32_t left(std::int32_t s, std::int32_t from) const {
    return sides(s)[(*this)[s].a == from ? 0 : 1];
  }
  [[nodiscard]] std::int32_t right(std::int32_t s, std::int32_t from) const {
    return sides(s)[(*this)[s].a == from ? 1 : 0];
  }
  void set_sides(std::int32_t s, std::int32_t from, std::int32_t left, std::int32_t right);
  [[nodiscard]] bool is_boundary(std::int32_t s) const { return (sides(s)[0] == kNone) != (sides(s)[1] == kNone); }

 private:
  [[nodiscard]] const std::array<std::int32_t, 2>& sides(std::int32_t s) const { return sides_[s]; }

  std::vector<Mesh::Edge> edges_;
  std::vector<std::array<std::int32_t, 2>> sides_;  // the triangle on the left and on the right of a -> b
  std::vector<std::uint32_t> first_;
  std::vector<std::int32_t> by_end_;
};

}  // namespace driftmesh
