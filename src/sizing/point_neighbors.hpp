#pragma once

#include <array>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include "driftmesh/id_vector.hpp"

namespace driftmesh {

/// The points that each point shares an edge with, in one array. One across an edge between two triangles appears
/// twice.
class PointNeighbors {
 public:
  PointNeighbors(std::size_t points, const std::vector<std::array<std::int32_t, 3>>& triangles)
      : first_(points + 1, 0) {
    for (const auto& triangle : triangles)
      for (const std::int32_t corner : triangle) first_[to_index(corner) + 1] += 2;
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    all_.resize(first_.back());
    std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
    for (const auto& triangle : triangles)
      for (std::size_t i = 0; i < 3; ++i)
        for (const std::size_t other : {(i + 1) % 3, (i + 2) % 3})
          all_[next[to_index(triangle[i])]++] = triangle[other];
  }

  [[nodiscard]] std::int32_t points() const { return static_cast<std::int32_t>(first_.size() - 1); }
  [[nodiscard]] std::span<const std::int32_t> of(std::int32_t point) const {
    const std::size_t begin = first_[to_index(point)];
    return std::span(all_).subspan(begin, first_[to_index(point) + 1] - begin);
  }

 private:
  std::vector<std::size_t> first_;  // where the neighbors of each point begin
  std::vector<std::int32_t> all_;
};

}  // namespace driftmesh
