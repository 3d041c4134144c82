#pragma once

#include <string>
#include <vector>

#include "picture/plot_canvas.hpp"
#include "picture/plot_frame.hpp"
#include "picture/plot_scale.hpp"

namespace driftmesh {

/// A vertical bar of the colors of viridis from low to high, with ticks on its left and a histogram on its right.
struct ColorBar {
  std::string title;
  std::vector<std::string> notes;  ///< lines below the title: the unit, and what a pixel shows
  double low = 0;
  double high = 1;
  std::vector<Tick> ticks;             ///< values on the scale of low and high
  std::vector<std::size_t> histogram;  ///< counts of equal parts from low to high
};

/// A bar for decimal logarithms from low to high, which its ticks show as the values that they are of.
[[nodiscard]] ColorBar logarithmic_bar(const std::string& title, double low, double high);

/// How many values are in each of 60 equal parts from low to high; those beyond count in the first and the last.
[[nodiscard]] std::vector<std::size_t> histogram_of(const std::vector<float>& values, double low, double high);

/// A category and its color.
struct Swatch {
  Rgb color;
  std::string label;
};

/// Draws nothing, like draw_swatches, if the frame has no room for a legend.
void draw_color_bar(Canvas& canvas, const PlotFrame& frame, const ColorBar& bar);

/// Draws as many swatches as fit, then the number of those left out.
void draw_swatches(Canvas& canvas, const PlotFrame& frame, const std::string& title,
                   const std::vector<Swatch>& swatches);

}  // namespace driftmesh
