#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "driftmesh/point.hpp"

namespace driftmesh {

/// A growing set of points no two of which are close (see closeness.hpp). Constant expected time per point for
/// any distribution: cells are 64 times as large as what counts as close there.
class PointWelder {
 public:
  explicit PointWelder(std::size_t expected);

  /// The index of a point of the set that `p` is close to (an equal one if there is one); otherwise adds `p` and
  /// returns its index.
  std::int32_t add(const Point& p);
  [[nodiscard]] const std::vector<Point>& points() const { return points_; }

 private:
  struct Cell {
    std::int64_t x = 0;
    std::int64_t y = 0;
    int exponent = 0;
    friend bool operator==(const Cell&, const Cell&) = default;
  };
  static Cell cell_of(const Point& p);
  static std::size_t hash(const Cell& cell);
  void search(const Cell& cell, const Point& p, std::int32_t& best) const;
  void insert(std::int32_t index);
  void grow();

  std::vector<Point> points_;
  std::vector<std::int32_t> slots_;  // open addressing; -1: free
};

}  // namespace driftmesh
