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
  /// Speeds up an add() of `p` that follows some others.
  void prefetch(const Point& p) const { __builtin_prefetch(&slots_[hash(cell_of(p)) & (slots_.size() - 1)]); }
  [[nodiscard]] const std::vector<Point>& points() const { return points_; }

 private:
  struct Cell {
    std::int64_t x = 0;
    std::int64_t y = 0;
    int exponent = 0;
    friend bool operator==(const Cell&, const Cell&) = default;
  };
  /// Where a point is found: most that are not close differ in the tag, and need not be looked at.
  struct Slot {
    std::uint32_t tag = 0;  // of the cell
    std::int32_t index = -1;
  };
  static Cell cell_of(const Point& p);
  static std::uint64_t hash(const Cell& cell);
  static std::uint32_t tag_of(std::uint64_t hash) { return static_cast<std::uint32_t>(hash >> 32); }
  void search(const Cell& cell, const Point& p, std::int32_t& best) const;
  void insert(std::int32_t index);
  void grow();

  std::vector<Point> points_;
  std::vector<Slot> slots_;  // open addressing; index -1: free
};

}  // namespace driftmesh
