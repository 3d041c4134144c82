#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "driftmesh/point.hpp"

namespace driftmesh {

/// Shapes of a block of triangles, in columns: the compiler turns the loops over them into vector instructions. Sums
/// are formed in the same order on every machine.
class ShapeColumns {
 public:
  static constexpr std::size_t kMost = 256;  // their columns fit in a first-level cache

  [[nodiscard]] std::size_t size() const { return count_; }
  [[nodiscard]] bool full() const { return count_ == kMost; }
  void clear() { count_ = 0; }
  /// Adds a counterclockwise triangle, unless full().
  void add(const Point& a, const Point& b, const Point& c) {
    of_.ax[count_] = a.x, of_.ay[count_] = a.y;
    of_.bx[count_] = b.x, of_.by[count_] = b.y;
    of_.cx[count_] = c.x, of_.cy[count_] = c.y;
    ++count_;
  }

  /// A whole block. Angles by the signed squares of their cosines, which order them as the cosines do, without a
  /// square root.
  struct Summary {
    double least_cosine = 1, greatest_cosine = -1;
    double least_twice_area, greatest_twice_area, twice_area;
    double least_margin;                    ///< negative if any triangle is skinny
    std::array<std::int32_t, 18> angles{};  ///< number of angles from 10 i to 10 (i + 1) degrees
  };
  /// Measures all triangles; those with an angle of a smaller sine than this are skinny.
  [[nodiscard]] Summary measure(double sine);

  // After measure():
  [[nodiscard]] double twice_area(std::size_t k) const { return of_.twice_area[k]; }
  [[nodiscard]] bool is_skinny(std::size_t k) const { return of_.margin[k] < 0; }

  struct Columns {
    using Column = std::array<double, kMost>;
    Column ax, ay, bx, by, cx, cy;  // the corners
    Column twice_area;
    Column margin;                        // negative for skinny triangles
    Column cosine_a, cosine_b, cosine_c;  // signed squares
  };

 private:
  std::size_t count_ = 0;
  Columns of_;
};

}  // namespace driftmesh
