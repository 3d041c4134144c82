#include "picture/plot_raster.hpp"

#include <cairo.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <iterator>
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
      counts_(keep == Keep::kMean ? values_.size() : 0, 0) {}

/// Calls visit(column, row) for the samples whose centers lie in a triangle, and returns whether there are any.
template <class Visit>
bool ValueRaster::scan(const Point& a, const Point& b, const Point& c, const Visit& visit) const {
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
      visit(column, row);
      reached = true;
    }
  }
  return reached;
}

void ValueRaster::add_triangle(const Point& a, const Point& b, const Point& c,
                               const std::function<float(const Point&)>& value_at) {
  scan(a, b, c, [&](std::int64_t column, std::int64_t row) {
    put(column, row,
        value_at({(static_cast<double>(column) + 0.5) / samples_, (static_cast<double>(row) + 0.5) / samples_}));
  });
}

void ValueRaster::add_triangle(const Point& a, const Point& b, const Point& c, float value) {
  const bool reached = scan(a, b, c, [&](std::int64_t column, std::int64_t row) { put(column, row, value); });
  if (reached || keep_ == Keep::kLast) return;
  const double x = samples_ * (a.x + b.x + c.x) / 3, y = samples_ * (a.y + b.y + c.y) / 3;
  if (x >= 0 && y >= 0 && x < static_cast<double>(columns_) && y < static_cast<double>(rows_))
    put(static_cast<std::int64_t>(x), static_cast<std::int64_t>(y), value);
}

/// Along a row or a column: each sum and count becomes that of those at most so many samples away.
void ValueRaster::add_up(std::int64_t first, std::int64_t step, std::int64_t count, int samples) {
  const auto size = static_cast<std::size_t>(count);
  std::vector<double> sums(size + 1, 0);
  std::vector<std::uint64_t> counts(size + 1, 0);
  const auto at = [&](std::size_t k) { return static_cast<std::size_t>(first + static_cast<std::int64_t>(k) * step); };
  for (std::size_t k = 0; k < size; ++k) {
    sums[k + 1] = sums[k] + double{values_[at(k)]};
    counts[k + 1] = counts[k] + counts_[at(k)];
  }
  const auto reach = static_cast<std::size_t>(samples);
  for (std::size_t k = 0; k < size; ++k) {
    const std::size_t from = k - std::min(k, reach), to = std::min(k + reach + 1, size);
    values_[at(k)] = static_cast<float>(sums[to] - sums[from]);
    counts_[at(k)] = static_cast<std::uint32_t>(counts[to] - counts[from]);
  }
}

void ValueRaster::average_around(int samples) {
  std::vector<bool> reached(values_.size());
  for (std::size_t i = 0; i < values_.size(); ++i) {
    reached[i] = !std::isnan(values_[i]);
    if (!reached[i]) values_[i] = 0;
  }
  for (std::int64_t row = 0; row < rows_; ++row) add_up(row * columns_, 1, columns_, samples);
  for (std::int64_t column = 0; column < columns_; ++column) add_up(column, columns_, rows_, samples);
  for (std::size_t i = 0; i < values_.size(); ++i)
    if (!reached[i]) values_[i] = std::numeric_limits<float>::quiet_NaN();
}

void ValueRaster::put(std::int64_t column, std::int64_t row, float value) {
  const auto index = static_cast<std::size_t>(row * columns_ + column);
  float& kept = values_[index];
  if (std::isnan(kept) || keep_ == Keep::kLast)
    kept = value;
  else if (keep_ == Keep::kMinimum)
    kept = std::min(kept, value);
  else
    kept += value;
  if (keep_ == Keep::kMean) ++counts_[index];
}

ValueRaster::Pixel ValueRaster::pixel(int x, int y, const std::function<Rgb(double)>& color_of) const {
  Pixel pixel;
  int reached = 0;
  for (int row = 0; row < samples_; ++row)
    for (int column = 0; column < samples_; ++column) {
      const auto index =
          static_cast<std::size_t>((std::int64_t{y} * samples_ + row) * columns_ + std::int64_t{x} * samples_ + column);
      if (std::isnan(values_[index])) continue;
      const double value = keep_ == Keep::kMean ? double{values_[index]} / counts_[index] : double{values_[index]};
      const Rgb color = color_of(value);
      pixel.color = {pixel.color.red + color.red, pixel.color.green + color.green, pixel.color.blue + color.blue};
      ++reached;
    }
  if (reached > 0) pixel.color = {pixel.color.red / reached, pixel.color.green / reached, pixel.color.blue / reached};
  pixel.coverage = static_cast<double>(reached) / (samples_ * samples_);
  return pixel;
}

void ValueRaster::paint(Canvas& canvas, const Point& origin, const std::function<Rgb(double)>& color_of) const {
  cairo_surface_t* const image = cairo_image_surface_create(CAIRO_FORMAT_ARGB32, width_, height_);
  cairo_surface_flush(image);
  unsigned char* const bytes = cairo_image_surface_get_data(image);
  const int stride = cairo_image_surface_get_stride(image);
  const auto byte_of = [](double v) { return static_cast<std::uint32_t>(std::clamp(v * 255 + 0.5, 0.0, 255.0)); };
  for (int y = 0; y < height_; ++y)
    for (int x = 0; x < width_; ++x) {
      const auto [color, coverage] = pixel(x, y, color_of);
      const std::uint32_t argb = byte_of(coverage) << 24 | byte_of(coverage * color.red) << 16 |
                                 byte_of(coverage * color.green) << 8 | byte_of(coverage * color.blue);
      std::memcpy(bytes + y * stride + 4 * x, &argb, 4);
    }
  cairo_surface_mark_dirty(image);
  cairo_set_source_surface(canvas.cairo(), image, origin.x, origin.y);
  cairo_pattern_set_filter(cairo_get_source(canvas.cairo()), CAIRO_FILTER_NEAREST);
  cairo_paint(canvas.cairo());
  cairo_surface_destroy(image);
}

std::vector<float> ValueRaster::values() const {
  std::vector<float> reached;
  std::ranges::copy_if(values_, std::back_inserter(reached), [](float value) { return !std::isnan(value); });
  return reached;
}

}  // namespace driftmesh
