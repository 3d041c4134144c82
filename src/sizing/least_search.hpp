#pragma once

#include <array>
#include <climits>
#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

#include "driftmesh/point.hpp"
#include "driftmesh/size_field.hpp"
#include "geometry/box.hpp"
#include "geometry/triangle_geometry.hpp"

namespace driftmesh {

// A triangle is compared with what a size field asks for between its corners and centroid with some tolerance, so that
// refinement neither chases the last percent of a smooth field nor has to find its exact minimum.

/// A length asked for somewhere in a triangle counts if it is less than this times the triangle's.
inline constexpr double kCounts = 0.9;
/// The search is over where no length in a triangle can be less than this times the triangle's.
inline constexpr double kTolerated = 0.8;

/// Finds out whether a function falls below a length anywhere in a triangle, by branch and bound: over the cells of
/// grids whose spacings are powers of two, with a bound of the function over each. Answers depend on the question
/// alone. Bounds are kept in a table of fixed size, because neighboring triangles ask for the same ones.
class LeastSearch {
 public:
  /// `lower_bound`: at most the least value over a box; infinite ends are allowed. `spacing`: where the bounds do not
  /// decide, the function is sampled at least this densely.
  LeastSearch(std::function<double(const Box&)> lower_bound, double spacing);

  /// The bound over the whole plane.
  [[nodiscard]] double least() const { return least_; }

  /// A bound over a triangle and what is near it.
  [[nodiscard]] double least_near(const CornerPoints& triangle);

  /// Whether `field` is below kCounts * length at a point that was looked at. If not, it is at least
  /// kTolerated * length everywhere, wherever the bounds approach the least values fast enough: for sure if they are
  /// exact, and otherwise where a value in question takes up more than `spacing` in both directions.
  [[nodiscard]] bool is_below(const SizeField& field, const CornerPoints& triangle, double length);

  /// The square [i w, (i + 1) w] x [j w, (j + 1) w] for w = 2^exponent.
  struct Cell {
    std::int64_t i = 0, j = 0;
    int exponent = 0;
    [[nodiscard]] double width() const;
    [[nodiscard]] Box box() const;
    /// Where coordinates have no digits left for its quarters.
    [[nodiscard]] bool is_smallest() const;
    [[nodiscard]] std::array<Cell, 4> quarters() const;
    /// The one of this width that a point is in: on a side, to the right or above.
    [[nodiscard]] static Cell around(const Point& p, int exponent);
    /// The lowest and leftmost of the cells, at most two in each direction, that cover a box and are larger than it.
    [[nodiscard]] static Cell first_of_cover(const Box& box);
    bool operator==(const Cell&) const = default;
  };
  [[nodiscard]] double lower_bound(const Cell& cell);

 private:
  struct Known {
    Cell cell{0, 0, INT_MIN};  // no cell
    double bound = 0;
  };
  struct Question;

  [[nodiscard]] Known& place_of(const Cell& cell);
  [[nodiscard]] double bound_around(const Cell& cell);
  [[nodiscard]] static Cell cell_around(const Box& box, int wider);
  [[nodiscard]] bool descend_from_cover(Question& question);
  [[nodiscard]] bool descend(Question& question, const Cell& cell);
  [[nodiscard]] bool start_dive(Question& question, const Cell& cell);
  [[nodiscard]] bool dive(Question& question, const Cell& cell, int depth);

  std::function<double(const Box&)> lower_bound_;
  double spacing_;
  double least_;  // over the whole plane
  std::vector<Known> known_;
  std::array<Known, 2> latest_;  // last results of least_near, for cells of even and of odd exponents
};

}  // namespace driftmesh
