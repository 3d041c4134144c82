#include "picture/plot_sizes.hpp"

#include <algorithm>
#include <cmath>

#include "picture/plot.hpp"
#include "picture/plot_canvas.hpp"
#include "picture/plot_frame.hpp"
#include "picture/plot_legend.hpp"
#include "picture/plot_lines.hpp"
#include "picture/plot_raster.hpp"
#include "picture/plot_scale.hpp"

namespace driftmesh {
namespace {

Box box_of(const DomainShape& domain) {
  Box box;
  for (const auto& triangle : domain.triangles)
    for (const Point& p : triangle) box.extend(p);
  return with_margin(box);
}

/// For all lengths in view.
ColorBar bar_of(const std::vector<float>& logs) {
  constexpr double kNarrowest = 0.2;  // decades
  const auto [least, most] = std::ranges::minmax_element(logs);
  const double low = logs.empty() ? 0 : *least, high = logs.empty() ? 1 : *most;
  const double missing = std::max(kNarrowest - (high - low), 0.0);
  ColorBar bar = logarithmic_bar("Target edge", low - missing / 2, high + missing / 2);
  bar.histogram = histogram_of(logs, bar.low, bar.high);
  return bar;
}

}  // namespace

void plot_sizes(const DomainShape& domain, const std::function<double(const Point&)>& length_at,
                const std::string& path, const PlotOptions& options) {
  const PlotFrame frame(shown_box(options, box_of(domain)), options.width, options.height, options.legend);
  Canvas canvas(path, frame.width(), frame.height());
  const Point origin{frame.plot().x, frame.plot().y};
  const auto inside = [&](const Point& p) {
    const Point at = frame.to_pixels(p);
    return Point{at.x - origin.x, at.y - origin.y};
  };
  const auto log_at = [&](const Point& pixel) {
    const Point& low = frame.shown().low;
    const double x = low.x + pixel.x / frame.scale(), y = frame.shown().high.y - pixel.y / frame.scale();
    return static_cast<float>(std::log10(length_at({x, y})));
  };
  ValueRaster raster(static_cast<int>(frame.plot().width), static_cast<int>(frame.plot().height), 1,
                     ValueRaster::Keep::kLast);
  for (const auto& [a, b, c] : domain.triangles) raster.add_triangle(inside(a), inside(b), inside(c), log_at);
  const std::vector<float> logs = raster.values();
  const ColorBar bar = bar_of(logs);
  std::string subtitle = options.subtitle;
  if (subtitle.empty() && !logs.empty()) {
    const auto [least, most] = std::ranges::minmax_element(logs);
    subtitle = "target edges from " + friendly_number(std::pow(10, double{*least})) + " to " +
               friendly_number(std::pow(10, double{*most}));
  }
  frame.draw_title(canvas, options.title, subtitle);
  frame.draw_axes(canvas);
  frame.begin_clip(canvas);
  raster.paint(canvas, origin, [&](double log) { return viridis((log - bar.low) / (bar.high - bar.low)); });
  {
    LineBatch batch(canvas, 0.7 * frame.unit(), kInk);
    for (const auto& [a, b] : domain.segments) batch.add(frame.to_pixels(a), frame.to_pixels(b));
  }
  PlotFrame::end_clip(canvas);
  if (options.legend) draw_color_bar(canvas, frame, bar);
  canvas.commit();
}

}  // namespace driftmesh
