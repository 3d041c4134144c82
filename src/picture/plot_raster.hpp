#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "driftmesh/point.hpp"
#include "picture/plot_canvas.hpp"
#include "picture/plot_color.hpp"

namespace driftmesh {

/// A grid of samples to which triangles are added by scan conversion, each with a value.
class ValueRaster {
 public:
  /// The value that a sample keeps if several triangles reach it.
  enum class Keep {
    kLast,     ///< the value of the one triangle that covers its center
    kMinimum,  ///< over all that cover it or have their centroid in it
    kMean      ///< likewise
  };

  /// width x height pixels of samples_per_side^2 samples each.
  ValueRaster(int width, int height, int samples_per_side, Keep keep);

  /// Corners in pixels, y down, in either orientation. Parts outside the raster are clipped.
  void add_triangle(const Point& a, const Point& b, const Point& c, float value);
  /// The same with a value of its own at the center of each sample, in pixels.
  void add_triangle(const Point& a, const Point& b, const Point& c, const std::function<float(const Point&)>& value_at);

  /// Replaces each mean by that of all triangles at most so many samples away in each direction. Only if means are
  /// kept.
  void average_around(int samples);

  /// One pixel as the mean of its samples' colors, and the fraction of the samples that any triangle reached.
  struct Pixel {
    Rgb color;
    double coverage = 0;
  };
  [[nodiscard]] Pixel pixel(int x, int y, const std::function<Rgb(double)>& color_of) const;

  /// Paints it with its upper left corner at a place of the canvas.
  void paint(Canvas& canvas, const Point& origin, const std::function<Rgb(double)>& color_of) const;
  /// The values of all samples that any triangle reached, if not their means are kept.
  [[nodiscard]] std::vector<float> values() const;

 private:
  template <class Visit>
  bool scan(const Point& a, const Point& b, const Point& c, const Visit& visit) const;
  void add_up(std::int64_t first, std::int64_t step, std::int64_t count, int samples);
  void put(std::int64_t column, std::int64_t row, float value);

  int width_;
  int height_;
  int samples_;
  Keep keep_;
  std::int64_t columns_;
  std::int64_t rows_;
  std::vector<float> values_;          // NaN: no triangle yet; a sum when the mean is kept
  std::vector<std::uint32_t> counts_;  // only when the mean is kept
};

}  // namespace driftmesh
