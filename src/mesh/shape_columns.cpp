#include "mesh/shape_columns.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/wide.hpp"

namespace driftmesh {
namespace {

constexpr std::size_t kLanes = 8;  // partial results, whatever the width of the machine's vectors

/// Bins of 10 degrees by the signed square of the cosine, without a trigonometric function, a search or a branch for
/// each of millions of angles: a table of narrow cells, each with at most one limit between two bins inside it.
class CosineBins {
 public:
  CosineBins() {
    for (std::size_t i = 0; i < 17; ++i) {
      const double c = std::cos(static_cast<double>(i + 1) * 10 * (std::numbers::pi / 180));
      limits_[i] = c * std::fabs(c);
    }
    limits_[17] = -2;  // no angle is past the last bin
    for (std::size_t cell = 0; cell < kCells; ++cell) {
      const double top = static_cast<double>(cell + 1) / kCellsPerUnit - 1;  // the smallest angles of the cell
      const auto it = std::find_if(limits_.begin(), limits_.end(), [&](double limit) { return top > limit; });
      first_[cell] = static_cast<std::uint8_t>(it - limits_.begin());
    }
  }
  [[nodiscard]] std::size_t operator()(double signed_square) const {
    const double place = (signed_square + 1) * kCellsPerUnit;
    const auto cell = static_cast<std::size_t>(std::clamp(place, 0.0, kCells - 1.0));
    const std::size_t first = first_[cell];
    return first + (signed_square <= limits_[first] ? 1 : 0);
  }

 private:
  static constexpr double kCellsPerUnit = 64;  // limits are at least 0.03 apart: at most one in a cell
  static constexpr std::size_t kCells = 128;
  std::array<double, 18> limits_{};
  std::array<std::uint8_t, kCells> first_{};
};

struct Extremes {
  double least, greatest, sum;
};

DRIFTMESH_WIDE Extremes extremes(const double* values, std::size_t count) {
  double least[kLanes], greatest[kLanes], sum[kLanes] = {};
  for (std::size_t l = 0; l < kLanes; ++l) least[l] = greatest[l] = values[0];
  const auto take = [&](std::size_t l, double v) {
    least[l] = v < least[l] ? v : least[l];
    greatest[l] = v > greatest[l] ? v : greatest[l];
    sum[l] += v;
  };
  std::size_t k = 0;
  for (; k + kLanes <= count; k += kLanes)
    for (std::size_t l = 0; l < kLanes; ++l) take(l, values[k + l]);
  for (; k < count; ++k) take(k % kLanes, values[k]);
  Extremes all{least[0], greatest[0], sum[0]};
  for (std::size_t l = 1; l < kLanes; ++l)
    all = {std::min(all.least, least[l]), std::max(all.greatest, greatest[l]), all.sum + sum[l]};
  return all;
}

inline double greater(double x, double y) {
  return x > y ? x : y;
}

/// By the law of cosines: of the angle between edges with these squared lengths.
inline double signed_square_of_cosine(double v, double w, double opposite) {
  const double x = v + w - opposite;
  return x * std::fabs(x) / (4 * v * w);
}

/// The sine of the smallest angle is twice the area over the product of the two longer edges.
DRIFTMESH_WIDE void measure_all(ShapeColumns::Columns& t, double sine_squared, std::size_t count) {
  for (std::size_t k = 0; k < count; ++k) {
    const double ux = t.ax[k] - t.cx[k], uy = t.ay[k] - t.cy[k], vx = t.bx[k] - t.cx[k], vy = t.by[k] - t.cy[k];
    const double wx = t.bx[k] - t.ax[k], wy = t.by[k] - t.ay[k];
    const double ca = ux * ux + uy * uy, bc = vx * vx + vy * vy, ab = wx * wx + wy * wy;
    const double twice_area = ux * vy - uy * vx;
    t.twice_area[k] = twice_area;
    t.margin[k] = twice_area * twice_area - sine_squared * greater(ab * bc, greater(bc * ca, ca * ab));
    t.cosine_a[k] = signed_square_of_cosine(ca, ab, bc);
    t.cosine_b[k] = signed_square_of_cosine(ab, bc, ca);
    t.cosine_c[k] = signed_square_of_cosine(bc, ca, ab);
  }
}

}  // namespace

ShapeColumns::Summary ShapeColumns::measure(double sine) {
  measure_all(of_, sine * sine, count_);
  const Extremes areas = extremes(of_.twice_area.data(), count_);
  Summary summary{.least_twice_area = areas.least,
                  .greatest_twice_area = areas.greatest,
                  .twice_area = areas.sum,
                  .least_margin = extremes(of_.margin.data(), count_).least};
  for (const Columns::Column* const cosines : {&of_.cosine_a, &of_.cosine_b, &of_.cosine_c}) {
    const Extremes found = extremes(cosines->data(), count_);
    summary.least_cosine = std::min(summary.least_cosine, found.least);
    summary.greatest_cosine = std::max(summary.greatest_cosine, found.greatest);
  }
  static const CosineBins bin;
  std::array<std::array<std::int32_t, 18>, 3> angles{};  // apart, so that no count waits for the one before
  for (std::size_t k = 0; k < count_; ++k) {
    ++angles[0][bin(of_.cosine_a[k])];
    ++angles[1][bin(of_.cosine_b[k])];
    ++angles[2][bin(of_.cosine_c[k])];
  }
  for (std::size_t i = 0; i < summary.angles.size(); ++i)
    summary.angles[i] = angles[0][i] + angles[1][i] + angles[2][i];
  return summary;
}

}  // namespace driftmesh
