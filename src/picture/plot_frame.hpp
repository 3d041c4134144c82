#pragma once

#include <string>

#include "geometry/box.hpp"
#include "picture/plot_canvas.hpp"

namespace driftmesh {

/// The layout of a picture: title above, axes left and below, legend on the right, and in between the plot, with one
/// scale for x and y.
class PlotFrame {
 public:
  /// `shown` is the part of the plane to show; height 0 is chosen to fit it. A box without extent is enlarged. A narrow
  /// picture has no legend, even if one is wanted: it would leave the plot less than its own width.
  PlotFrame(const Box& shown, int width, int height, bool wants_legend);

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  /// A thousandth of the picture's width, within limits: the unit of fonts, lines and gaps.
  [[nodiscard]] double unit() const { return unit_; }
  /// The rectangle of the plot.
  [[nodiscard]] const PixelRect& plot() const { return plot_; }
  [[nodiscard]] bool has_legend() const { return legend_.width > 0; }
  [[nodiscard]] const PixelRect& legend() const { return legend_; }
  /// The part of the plane that the plot shows, at least the part asked for.
  [[nodiscard]] const Box& shown() const { return shown_; }
  /// Pixels per unit of length.
  [[nodiscard]] double scale() const { return scale_; }
  [[nodiscard]] Point to_pixels(const Point& p) const {
    return {plot_.x + (p.x - shown_.low.x) * scale_, plot_.y + (shown_.high.y - p.y) * scale_};
  }

  /// A title wider than the picture is drawn smaller; of a subtitle, whose parts have three spaces between them, only
  /// the first parts that fit are drawn.
  void draw_title(Canvas& canvas, const std::string& title, const std::string& subtitle) const;
  void draw_axes(Canvas& canvas) const;
  /// Restricts drawing to the plot until end_clip.
  void begin_clip(Canvas& canvas) const;
  static void end_clip(Canvas& canvas);

 private:
  int width_;
  int height_;
  double unit_;
  double left_ = 0;  // margin for the labels of the y axis
  PixelRect plot_;
  PixelRect legend_;
  Box shown_;
  double scale_ = 1;
};

}  // namespace driftmesh
