#include "raster/nearest_points.hpp"

#include <limits>
#include <vector>

#include "base/mapped_array.hpp"

namespace driftmesh {
namespace {

constexpr std::int32_t kNoRow = -1;

/// For each point the row of the nearest sought one in its column, the lower of two; kNoRow: the column has none.
MappedArray<std::int32_t> nearest_rows(const TiledGrid& grid, const std::function<bool(float)>& is_sought) {
  const auto [columns, rows, first, dx, dy] = grid.frame();
  MappedArray<std::int32_t> nearest(static_cast<std::uint64_t>(columns * rows));
  for (std::int64_t j = 0; j < rows; ++j)
    for (std::int64_t i = 0; i < columns; ++i) {
      const auto here = static_cast<std::uint64_t>(j * columns + i);
      const std::int32_t below = j > 0 ? nearest[here - static_cast<std::uint64_t>(columns)] : kNoRow;
      nearest[here] = is_sought(grid.at(i, j)) ? static_cast<std::int32_t>(j) : below;
    }
  for (std::int64_t j = rows - 2; j >= 0; --j)
    for (std::int64_t i = 0; i < columns; ++i) {
      const auto here = static_cast<std::uint64_t>(j * columns + i);
      const std::int32_t below = nearest[here], above = nearest[here + static_cast<std::uint64_t>(columns)];
      if (above != kNoRow && (below == kNoRow || above - j < j - below)) nearest[here] = above;
    }
  return nearest;
}

/// The lower envelope of the parabolas offset_k + (width (i - k))^2 over the columns k of a row.
class Envelope {
 public:
  explicit Envelope(double width) : width_(width) {}

  void clear() { parabolas_.clear(); }
  /// Columns in ascending order.
  void add(std::int64_t column, double offset) {
    double begin = -std::numeric_limits<double>::infinity();
    while (!parabolas_.empty()) {
      begin = crossing(parabolas_.back(), column, offset);
      if (begin > parabolas_.back().begin) break;
      parabolas_.pop_back();
      begin = -std::numeric_limits<double>::infinity();
    }
    parabolas_.push_back({column, offset, begin});
    at_ = 0;
  }
  /// The column of the lowest parabola at i, which rises from call to call.
  [[nodiscard]] std::int64_t lowest_at(std::int64_t i) {
    while (at_ + 1 < parabolas_.size() && parabolas_[at_ + 1].begin < static_cast<double>(i)) ++at_;
    return parabolas_[at_].column;
  }
  [[nodiscard]] bool empty() const { return parabolas_.empty(); }

 private:
  struct Parabola {
    std::int64_t column;
    double offset;
    double begin;  // start of the part where it is the lowest
  };
  [[nodiscard]] double crossing(const Parabola& left, std::int64_t column, double offset) const {
    const auto a = static_cast<double>(left.column), b = static_cast<double>(column);
    return (a + b) / 2 + (offset - left.offset) / (2 * width_ * width_ * (b - a));
  }

  double width_;
  std::vector<Parabola> parabolas_;
  std::size_t at_ = 0;
};

}  // namespace

void for_each_nearest(
    const TiledGrid& grid, double width, double height, const std::function<bool(float)>& is_sought,
    const std::function<void(std::int64_t i, std::int64_t j, std::int64_t near_i, std::int64_t near_j)>& visit) {
  const std::int64_t columns = grid.frame().columns, rows = grid.frame().rows;
  const MappedArray<std::int32_t> nearest = nearest_rows(grid, is_sought);
  const auto row_near = [&](std::int64_t i, std::int64_t j) {
    return nearest[static_cast<std::uint64_t>(j * columns + i)];
  };
  Envelope envelope(width);
  for (std::int64_t j = 0; j < rows; ++j) {
    envelope.clear();
    for (std::int64_t i = 0; i < columns; ++i)
      if (const std::int32_t row = row_near(i, j); row != kNoRow) {
        const double away = height * static_cast<double>(row - j);
        envelope.add(i, away * away);
      }
    if (envelope.empty()) return;
    for (std::int64_t i = 0; i < columns; ++i) {
      const std::int64_t from = envelope.lowest_at(i);
      visit(i, j, from, row_near(from, j));
    }
  }
}

}  // namespace driftmesh
