#include "picture/plot_raster.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace driftmesh {
namespace {

// The first sample whose center is at or beyond a coordinate.
std::int64_t first_sample(double coordinate, std::int64_t count) {
  return static_cast<std::int64_t>(std::ceil(std::clamp(coordinate, 0.0, static_cast<double>(count)) - 0.5));
}

// The x at which an edge crosses the horizontal line at y.
double crossing(const Point& a, const Point& b, double y) {
  return a.x + (b.x - a.x) * ((y - a.y) / (b.y - a.y));
}

}  // namespace

ValueRaster::ValueRaster(int width, int height, int samples_per_side, Keep keep)
    : width_(width),
      height_(height),
      samples_(samples_per_side),
      keep_(keep),
      columns_(std::int64_t{width} * samples_per_side),
      rows_(std::int64_t{height} * samples_per_side),
      values_(static_cast<std::size_t>(columns_ * rows_), std::numeric_limits<float>::quiet_NaN()),
      counts_(keep == Keep::mean ? values_.size() : 0, 0) {}

void ValueRaster::add_triangle(const Point& a, const Point& b, const Point& c, float value) {
  const auto scaled = [this](const Point& p) { return Point{p.x * samples_, p.y * samples_}; };
  std::array<Point, 3> corner = {scaled(a), scaled(b), scaled(c)};
  std::sort(corner.begin(), corner.end(), [](const Point& p, const Point& q) { return p.y < q.y; });
  bool reached = false;
  const std::int64_t end = first_sample(corner[2].y, rows_);
  for (std::int64_t row = first_sample(corner[0].y, rows_); row < end; ++row) {
    const double y = static_cast<double>(row) + 0.5;
    const double on_long_edge = crossing(corner[0], corner[2], y);
    const double on_short_edge =
        y < corner[1].y ? crossing(corner[0], corner[1], y) : crossing(corner[1], corner[2], y);
    const auto [from, to] = std::minmax(on_long_edge, on_short_edge);
    const std::int64_t last = first_sample(to, columns_);
    for (std::int64_t column = first_sample(from, columns_); column < last; ++column) {
      put(column, row, value);
      reached = true;
    }
  }
  if (reached || keep_ == Keep::last) return;
  const double x = (corner[0].x + corner[1].x + corner[2].x) / 3;
  const double y = (corner[0].y + corner[1].y + corner[2].y) / 3;
  if (x >= 0 && y >= 0 && x < static_cast<double>(columns_) && y < static_cast<double>(rows_))
    put(static_cast<std::int64_t>(x), static_cast<std::int64_t>(y), value);
}

void ValueRaster::put(std::int64_t column, std::int64_t row, float value) {
  const auto index = static_cast<std::size_t>(row * columns_ + column);
  float& kept = values_[index];
  if (std::isnan(kept) || keep_ == Keep::last)
    kept = value;
  else if (keep_ == Keep::minimum)
    kept = std::min(kept, value);
  else
    kept += value;
  if (keep_ == Keep::mean) ++counts_[index];
}

ValueRaster::Pixel ValueRaster::pixel(int x, int y, const std::function<Rgb(double)>& color_of) const {
  Pixel pixel;
  int reached = 0;
  for (int row = 0; row < samples_; ++row)
    for (int column = 0; column < samples_; ++column) {
      const auto index =
          static_cast<std::size_t>((std::int64_t{y} * samples_ + row) * columns_ + std::int64_t{x} * samples_ + column);
      if (std::isnan(values_[index])) continue;
      const double value = keep_ == Keep::mean ? double{values_[index]} / counts_[index] : double{values_[index]};
      const Rgb color = color_of(value);
      pixel.color = {pixel.color.red + color.red, pixel.color.green + color.green, pixel.color.blue + color.blue};
      ++reached;
    }
  if (reached > 0) pixel.color = {pixel.color.red / reached, pixel.color.green / reached, pixel.color.blue / reached};
  pixel.coverage = static_cast<double>(reached) / (samples_ * samples_);
  return pixel;
}

}  // namespace driftmesh
