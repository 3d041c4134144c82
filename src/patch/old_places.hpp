#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "driftmesh/mesh.hpp"
#include "driftmesh/point.hpp"

namespace driftmesh::patch {

/// Finds points and triangles of a mesh by where they are, bit for bit.
class OldPlaces {
 public:
  /// The mesh must outlive the object.
  explicit OldPlaces(const Mesh& mesh);

  /// The number of the point that is exactly there, the lowest of several; -1: none is.
  [[nodiscard]] std::int32_t point_at(const Point& p) const;
  /// The number of the triangle with these points, in any order; -1: there is none.
  [[nodiscard]] std::int32_t triangle_of(std::array<std::int32_t, 3> points) const;

 private:
  /// Numbers in the slots that their hashes name, or behind them.
  class Table {
   public:
    explicit Table(std::size_t count);
    /// The slot of the first number that is the one, or a free one.
    template <class IsTheOne>
    [[nodiscard]] std::size_t slot(std::size_t hash, const IsTheOne& is_the_one) const;
    [[nodiscard]] std::int32_t& operator[](std::size_t slot) { return slots_[slot]; }
    [[nodiscard]] std::int32_t operator[](std::size_t slot) const { return slots_[slot]; }

   private:
    std::vector<std::int32_t> slots_;  // a power of two; -1: free
  };
  [[nodiscard]] std::size_t slot_of(const Point& p) const;
  [[nodiscard]] std::size_t slot_of(const std::array<std::int32_t, 3>& ascending) const;

  const Mesh& mesh_;
  Table points_, triangles_;
};

}  // namespace driftmesh::patch
