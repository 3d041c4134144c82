#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "driftmesh/point.hpp"
#include "pslg/closeness.hpp"

namespace driftmesh {

/// A growing set of points no two of which are close. Constant expected time per point for any distribution: the points
/// lie in cells that are 32 to 64 times as large as what counts as close there.
class PointWelder {
 public:
  explicit PointWelder(std::size_t expected, const Closeness& closeness = Closeness());

  /// The index of the point of the set that is nearest to `p` and close to it, the first of several; if there is none,
  /// adds `p` and returns its index.
  std::int32_t add(const Point& p);
  /// Speeds up an add() of `p` that follows some others.
  void prefetch(const Point& p) const { __builtin_prefetch(&slots_[hash(cell_of(p)) & (slots_.size() - 1)]); }
  [[nodiscard]] const std::vector<Point>& points() const { return points_; }

 private:
  struct Cell {
    std::int64_t x = 0;
    std::int64_t y = 0;
    int level = 0;  // cells of one level are of one size
    friend bool operator==(const Cell&, const Cell&) = default;
  };
  /// Where a point is found: most that are not close differ in the tag, and need not be looked at.
  struct Slot {
    std::uint32_t tag = 0;  // from the cell
    std::int32_t index = -1;
  };
  struct Nearest {
    std::int32_t index = -1;
    double squared = 0;  // squared distance
  };
  static int level_of(double close);
  [[nodiscard]] Cell cell_of(const Point& p) const;
  static std::uint64_t hash(const Cell& cell);
  static std::uint32_t tag_of(std::uint64_t hash) { return static_cast<std::uint32_t>(hash >> 32); }
  void search_level(int level, const Point& p, double reach, Nearest& nearest) const;
  void search(const Cell& cell, const Point& p, Nearest& nearest) const;
  void insert(std::int32_t index);
  void grow();

  Closeness closeness_;
  std::vector<Point> points_;
  std::vector<Slot> slots_;  // open addressing; index -1: free
};

}  // namespace driftmesh
