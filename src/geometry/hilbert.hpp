#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

#include "driftmesh/point.hpp"

namespace driftmesh {

namespace hilbert_detail {

inline constexpr int kStates = 4;       // the curve of a square, its transpose, and both turned by 180 degrees
inline constexpr int kBitsPerStep = 4;  // bits per axis
inline constexpr int kCells = 1 << (2 * kBitsPerStep);

/// For a state and a cell (x bits, y bits) of a 16 x 16 square: the cell's index along the curve, and the state inside
/// the cell in the two low bits.
using StepTable = std::array<std::array<std::uint16_t, kCells>, kStates>;

/// Bit 0 of a state: transposed; bit 1: turned. One bit of each axis picks a quadrant; the quadrants at both ends of
/// the curve hold a transposed curve, the last of them turned too.
constexpr StepTable make_step_table() {
  StepTable table{};
  for (unsigned start = 0; start < kStates; ++start)
    for (unsigned cell = 0; cell < kCells; ++cell) {
      unsigned state = start, index = 0;
      for (int bit = kBitsPerStep - 1; bit >= 0; --bit) {
        unsigned x = cell >> (kBitsPerStep + bit) & 1, y = cell >> bit & 1;
        if (state & 2) x ^= 1, y ^= 1;
        if (state & 1) std::swap(x, y);
        index = index << 2 | ((3 * x) ^ y);
        if (y == 0) state ^= x == 1 ? 3 : 1;
      }
      table[start][cell] = static_cast<std::uint16_t>(index << 2 | state);
    }
  return table;
}

inline constexpr StepTable kStepTable = make_step_table();

}  // namespace hilbert_detail

/// Index of the cell (x, y) of a 2^32 x 2^32 grid along the Hilbert curve. Cells of consecutive indices share a side;
/// the upper 2k bits are the index of the cell of the 2^k x 2^k grid that contains it.
[[nodiscard]] inline std::uint64_t hilbert_index(std::uint32_t x, std::uint32_t y) {
  using namespace hilbert_detail;
  std::uint64_t index = 0;
  unsigned state = 0;
  for (int shift = 32 - kBitsPerStep; shift >= 0; shift -= kBitsPerStep) {
    const unsigned cell = (x >> shift & 15) << kBitsPerStep | (y >> shift & 15);
    const unsigned step = kStepTable[state][cell];
    index = index << (2 * kBitsPerStep) | step >> 2;
    state = step & 3;
  }
  return index;
}

/// Maps points of a box to positions on a Hilbert curve, for sorting by locality.
class HilbertOrder {
 public:
  /// The box from `low` to `high`, low <= high and finite; it may have no width or no height.
  HilbertOrder(const Point& low, const Point& high)
      : low_(low), scale_(kGrid / std::max({high.x - low.x, high.y - low.y, 0x1p-900})) {}

  /// Points outside the box count as the nearest point of the square at `low` that encloses it.
  [[nodiscard]] std::uint64_t index(const Point& p) const {
    return hilbert_index(cell(p.x - low_.x), cell(p.y - low_.y));
  }

 private:
  static constexpr double kGrid = 4294967295.0;
  [[nodiscard]] std::uint32_t cell(double distance) const {
    return static_cast<std::uint32_t>(static_cast<std::int64_t>(std::clamp(distance * scale_, 0.0, kGrid)));
  }

  Point low_;
  double scale_;
};

}  // namespace driftmesh
