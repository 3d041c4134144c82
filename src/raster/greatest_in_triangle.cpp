#include "raster/greatest_in_triangle.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace driftmesh {
namespace {

/// The numbers of the grid lines from `low` to `high`; none if first > last.
struct Lines {
  std::int64_t first, last;
};
Lines lines_between(double low, double high, double origin, double spacing, std::int64_t count) {
  const auto number = [&](double x) { return std::clamp((x - origin) / spacing, -1.0, static_cast<double>(count)); };
  return {std::max<std::int64_t>(static_cast<std::int64_t>(std::ceil(number(low))), 0),
          std::min(static_cast<std::int64_t>(std::floor(number(high))), count - 1)};
}

bool precedes(const Point& a, const Point& b) {
  return a.x != b.x ? a.x < b.x : a.y < b.y;
}

/// A bilinear function has no maximum inside a cell, only saddles, and is quadratic along lines. So it is greatest at
/// points of the grid, or on an edge of the triangle, at an end of the edge's part in the cell or in between.
class Search {
 public:
  Search(const Raster& raster, CornerPoints corners) : raster_(raster), corners_(corners) {
    std::ranges::sort(corners_, precedes);
  }

  double run() {
    for (const std::size_t k : {0, 1, 2}) along(corners_[k == 2 ? 1 : 0], corners_[k == 0 ? 1 : 2]);
    for (const RasterFrame& frame : raster_.frames()) inside(frame);
    return greatest_;
  }

 private:
  double look(const Point& p) {
    const double value = raster_.at(p);
    greatest_ = std::max(greatest_, value);
    return value;
  }

  void along(const Point& a, const Point& b) {
    cuts_.assign({0, 1});
    for (const RasterFrame& frame : raster_.frames()) {
      cut(a.x, b.x, frame.first.x, frame.dx, frame.columns);
      cut(a.y, b.y, frame.first.y, frame.dy, frame.rows);
    }
    std::ranges::sort(cuts_);
    const auto at = [&](double t) { return look({a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)}); };
    double before = look(a);
    for (std::size_t i = 1; i < cuts_.size(); ++i) {
      const double begin = cuts_[i - 1], length = cuts_[i] - begin;
      if (!(length > 0)) continue;
      const double middle = at(begin + length / 2), behind = i + 1 == cuts_.size() ? look(b) : at(cuts_[i]);
      const double bend = 2 * (before + behind - 2 * middle);  // the values are before + rise s + bend s^2
      const double rise = behind - before - bend;
      if (bend < 0 && rise > 0 && rise < -2 * bend) at(begin + length * (rise / (-2 * bend)));
      before = behind;
    }
  }

  void cut(double from, double to, double origin, double spacing, std::int64_t count) {
    if (from == to) return;
    const Lines lines = lines_between(std::min(from, to), std::max(from, to), origin, spacing, count);
    for (std::int64_t i = lines.first; i <= lines.last; ++i)
      cuts_.push_back(std::clamp((origin + static_cast<double>(i) * spacing - from) / (to - from), 0.0, 1.0));
  }

  void inside(const RasterFrame& frame) {
    const auto [low, high] = std::minmax({corners_[0].y, corners_[1].y, corners_[2].y});
    const Lines rows = lines_between(low, high, frame.first.y, frame.dy, frame.rows);
    for (std::int64_t j = rows.first; j <= rows.last; ++j) {
      const double y = frame.first.y + static_cast<double>(j) * frame.dy;
      const auto [left, right] = stretch_at(y);
      const Lines columns = lines_between(left, right, frame.first.x, frame.dx, frame.columns);
      for (std::int64_t i = columns.first; i <= columns.last; ++i)
        look({frame.first.x + static_cast<double>(i) * frame.dx, y});
    }
  }

  struct Stretch {
    double left, right;
  };
  [[nodiscard]] Stretch stretch_at(double y) const {
    Stretch found{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
    for (const std::size_t k : {0, 1, 2}) {
      const Point &a = corners_[k], &b = corners_[(k + 1) % 3];
      if (y < std::min(a.y, b.y) || y > std::max(a.y, b.y) || a.y == b.y) continue;
      const double x = a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x);
      found = {std::min(found.left, x), std::max(found.right, x)};
    }
    return found;
  }

  const Raster& raster_;
  CornerPoints corners_;
  std::vector<double> cuts_;
  double greatest_ = -std::numeric_limits<double>::infinity();
};

}  // namespace

double greatest_in(const Raster& raster, const CornerPoints& triangle) {
  return Search(raster, triangle).run();
}

}  // namespace driftmesh
