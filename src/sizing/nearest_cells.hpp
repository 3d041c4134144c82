#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "geometry/box.hpp"
#include "geometry/box_tree.hpp"

namespace driftmesh {

/// Finds the nearest of some segments, by squares that keep the few segments which can be nearest to a point in them.
///
/// Squares are made where questions come, and divided where many do, so that making them takes about as long at most as
/// what has been asked there so far; before, and outside of all squares, a tree of boxes answers. Which segments a
/// square keeps follows from those of the square around it. Queries are const, depend on their arguments alone, and may
/// run in several threads at once.
class NearestCells {
 public:
  struct Ends {
    Point a, b;
  };
  /// At least one segment.
  explicit NearestCells(std::vector<Ends> segments);
  ~NearestCells();

  /// The least of squared_distance(p, segment), to the last bit.
  [[nodiscard]] double squared_distance(const Point& p) const;
  /// Up to rounding errors of some units in the last place of the coordinates, whose differences must not overflow.
  /// Not less than that of the segment's box, so that no rounding error makes the least depend on the order of a
  /// search.
  [[nodiscard]] static double squared_distance(const Point& p, const Ends& segment);

  /// The box around all segments.
  [[nodiscard]] const Box& box() const { return box_; }
  /// How many squares there are, at most six for each segment and 10,000.
  [[nodiscard]] std::size_t size() const { return size_.load(std::memory_order_relaxed); }

 private:
  struct Node;
  struct Quarters;
  class Square;
  using Items = std::span<const std::int32_t>;
  /// A square of the grid that divides the root `depth` times, by the place of a point in the finest grid.
  struct Place {
    std::uint32_t i, j;
    int depth;
  };

  [[nodiscard]] double by_tree(const Point& p) const;
  [[nodiscard]] double least(const Point& p, Items items) const;
  void note_question(Node& node, Items near, const Place& place) const;
  void find_near(Node& node, const Place& place) const;
  void divide(Node& node, Items near, const Place& place) const;
  [[nodiscard]] Square square(const Place& place, Items among) const;
  [[nodiscard]] bool take_room() const;

  std::vector<Ends> segments_;
  BoxTree tree_;
  Box box_;
  Point low_{};       // corner of the root
  double width_ = 0;  // width of the finest squares; 0: there are no squares
  double margin_ = 0;
  std::unique_ptr<Node> root_;
  mutable std::atomic<std::size_t> size_{1};
};

}  // namespace driftmesh
