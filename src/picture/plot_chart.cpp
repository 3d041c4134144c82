#include "picture/plot_chart.hpp"

#include <cairo.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "picture/plot_canvas.hpp"
#include "picture/plot_lines.hpp"
#include "picture/plot_scale.hpp"

namespace driftmesh {
namespace {

constexpr int kWidth = 1400, kHeight = 800;
constexpr PixelRect kPlot{110, 120, kWidth - 150, kHeight - 215};
constexpr double kBottom = kPlot.y + kPlot.height;
constexpr double kRight = kPlot.x + kPlot.width;
constexpr Rgb kGrid{0.90, 0.91, 0.93};
const TextStyle kTickText{.size = 16, .color = kFaintInk};

/// One axis: values to pixels.
struct Axis {
  double low, high;
  double at_low, at_high;  // pixels
  bool logarithmic = false;

  [[nodiscard]] double pixel(double value) const {
    const double t = logarithmic ? std::log(value / low) / std::log(high / low) : (value - low) / (high - low);
    return at_low + t * (at_high - at_low);
  }
  [[nodiscard]] std::vector<Tick> ticks(int wanted) const {
    return logarithmic ? logarithmic_ticks(low, high, wanted) : linear_ticks(low, high, wanted);
  }
};

Axis y_axis(double low, double high) {
  if (!(high > low)) high = low + 1;
  return {low, high, kBottom, kPlot.y};
}

Axis x_axis(double low, double high, bool logarithmic = false) {
  if (!(high > low)) high = logarithmic ? 2 * low : low + 1;
  return {low, high, kPlot.x, kRight, logarithmic};
}

class Chart {
 public:
  Chart(const ChartText& text, const std::string& path) : canvas_(path, kWidth, kHeight) {
    canvas_.text({kPlot.x - 70, 44}, text.title, {.size = 26, .bold = true});
    canvas_.text({kPlot.x - 70, 72}, text.subtitle, {.size = 17, .color = kFaintInk});
    canvas_.text({kPlot.x - 70, 106}, text.y_label, kTickText);
    canvas_.text({kRight, kBottom + 72}, text.x_label, {.size = 16, .color = kFaintInk, .align = TextAlign::right});
  }

  Canvas& canvas() { return canvas_; }

  void draw_y(const Axis& y) {
    for (const Tick& tick : y.ticks(7)) {
      canvas_.line({kPlot.x, y.pixel(tick.value)}, {kRight, y.pixel(tick.value)}, 1, kGrid);
      canvas_.text({kPlot.x - 10, y.pixel(tick.value) + 5}, tick.label,
                   {.size = 16, .color = kFaintInk, .align = TextAlign::right});
    }
  }
  void draw_x(const Axis& x) {
    for (const Tick& tick : x.ticks(12)) {
      canvas_.line({x.pixel(tick.value), kBottom}, {x.pixel(tick.value), kBottom + 6}, 1, kFaintInk);
      canvas_.text({x.pixel(tick.value), kBottom + 24}, tick.label,
                   {.size = 16, .color = kFaintInk, .align = TextAlign::center});
    }
  }
  void draw_base() { canvas_.line({kPlot.x, kBottom}, {kRight, kBottom}, 1.5, kFaintInk); }

  /// A color and what it stands for, from right to left above the plot.
  void draw_legend(const std::vector<std::pair<Rgb, std::string>>& entries) {
    double width = 0;
    for (const auto& entry : entries) width += 46 + canvas_.text_width(entry.second, kTickText);
    double x = kRight - width;
    for (const auto& [color, name] : entries) {
      canvas_.fill_rect({x, 92, 20, 14}, color);
      canvas_.text({x + 26, 105}, name, kTickText);
      x += 46 + canvas_.text_width(name, kTickText);
    }
  }

  void commit() { canvas_.commit(); }

 private:
  Canvas canvas_;
};

void draw_bars(Chart& chart, const StackedBars& bars, const Axis& y, std::size_t count) {
  const double step = kPlot.width / static_cast<double>(count);
  const double gap = step > 6 ? 0.15 * step : 0;
  for (std::size_t b = 0; b < count; ++b) {
    double height = 0;
    for (const StackedBars::Part& part : bars.parts) {
      const double top = height + part.heights[b];
      const double x = kPlot.x + static_cast<double>(b) * step;
      chart.canvas().fill_rect({x + gap / 2, y.pixel(top), step - gap, y.pixel(height) - y.pixel(top)}, part.color);
      height = top;
    }
  }
}

void draw_groups(Chart& chart, const StackedBars& bars, std::size_t count) {
  const double step = kPlot.width / static_cast<double>(count);
  double x = kPlot.x;
  for (const StackedBars::Group& group : bars.groups) {
    const double width = step * static_cast<double>(group.bars);
    chart.canvas().line({x + 3, kBottom + 32}, {x + width - 3, kBottom + 32}, 2, kFaintInk);
    chart.canvas().text({x + width / 2, kBottom + 50}, group.name,
                        {.size = 16, .color = kInk, .align = TextAlign::center});
    x += width;
  }
}

void draw_curve(Chart& chart, const LineChart::Curve& curve, const Axis& x, const Axis& y) {
  cairo_t* const cairo = chart.canvas().cairo();
  for (const Point& p : curve.points) cairo_line_to(cairo, x.pixel(p.x), y.pixel(p.y));
  if (!curve.low.empty()) {
    for (std::size_t i = curve.points.size(); i-- > 0;)
      cairo_line_to(cairo, x.pixel(curve.points[i].x), y.pixel(curve.low[i]));
    chart.canvas().set_color(curve.color);
    cairo_fill(cairo);
    return;
  }
  chart.canvas().set_color(curve.color);
  cairo_set_line_width(cairo, 3);
  cairo_set_line_join(cairo, CAIRO_LINE_JOIN_ROUND);
  cairo_stroke(cairo);
  for (const Point& p : curve.points) {
    if (!curve.marks) break;
    cairo_arc(cairo, x.pixel(p.x), y.pixel(p.y), 5, 0, 2 * M_PI);
    cairo_fill(cairo);
  }
}

}  // namespace

void plot_chart(const StackedBars& bars, const std::string& path) {
  const std::size_t count = bars.parts.empty() ? 0 : bars.parts[0].heights.size();
  double highest = 0;
  for (std::size_t b = 0; b < count; ++b) {
    double height = 0;
    for (const StackedBars::Part& part : bars.parts) height += part.heights[b];
    highest = std::max(highest, height);
  }
  const Axis y = y_axis(0, highest * 1.02);
  Chart chart(bars.text, path);
  chart.draw_y(y);
  if (count > 0) draw_bars(chart, bars, y, count);
  if (count > 1) {
    const double half = 0.5 * kPlot.width / static_cast<double>(count);  // the number is centered below the bar
    chart.draw_x({0, static_cast<double>(count - 1), kPlot.x + half, kRight - half});
  }
  chart.draw_base();
  if (count > 0) draw_groups(chart, bars, count);
  std::vector<std::pair<Rgb, std::string>> legend;
  for (const StackedBars::Part& part : bars.parts) legend.emplace_back(part.color, part.name);
  chart.draw_legend(legend);
  chart.commit();
}

void plot_chart(const LineChart& lines, const std::string& path) {
  double left = HUGE_VAL, right = -HUGE_VAL, top = lines.y_from;
  for (const LineChart::Curve& curve : lines.curves)
    for (const Point& p : curve.points)
      left = std::min(left, p.x), right = std::max(right, p.x), top = std::max(top, p.y);
  if (!(left <= right)) left = right = 1;
  const Axis x = x_axis(left, right, lines.logarithmic_x && left > 0);
  const Axis y = y_axis(lines.y_from, lines.y_from + 1.05 * (top - lines.y_from));
  Chart chart(lines.text, path);
  chart.draw_y(y);
  chart.draw_x(x);
  chart.draw_base();
  std::vector<std::pair<Rgb, std::string>> legend;
  for (const LineChart::Curve& curve : lines.curves) {
    draw_curve(chart, curve, x, y);
    if (!curve.name.empty()) legend.emplace_back(curve.color, curve.name);
  }
  chart.draw_legend(legend);
  chart.commit();
}

void plot_chart(const Timeline& timeline, const std::string& path) {
  const Axis x = x_axis(0, timeline.end);
  const double step = kPlot.height / static_cast<double>(std::max<std::size_t>(timeline.rows, 1));
  const auto row = [&](std::size_t r) { return kPlot.y + (static_cast<double>(r) + 0.5) * step; };
  Chart chart(timeline.text, path);
  const double thick = std::max(0.55 * step, 0.8);
  for (std::size_t r = 0; r < timeline.busy.size(); ++r)
    for (const Point& span : timeline.busy[r])
      chart.canvas().fill_rect({x.pixel(span.x), row(r) - thick / 2, x.pixel(span.y) - x.pixel(span.x), thick},
                               {0.80, 0.86, 0.93});
  {
    LineBatch arrows(chart.canvas(), timeline.arrows.size() > 500 ? 0.8 : 1.6, kAlarm, 0.6);
    for (const Timeline::Arrow& a : timeline.arrows)
      arrows.add({x.pixel(a.from_time), row(a.from_row)}, {x.pixel(a.to_time), row(a.to_row)});
  }
  for (const Timeline::Arrow& a : timeline.arrows) {
    chart.canvas().set_color(kAlarm);
    cairo_arc(chart.canvas().cairo(), x.pixel(a.to_time), row(a.to_row), timeline.arrows.size() > 500 ? 1.6 : 3, 0,
              2 * M_PI);
    cairo_fill(chart.canvas().cairo());
  }
  chart.draw_x(x);
  // No more ticks than steps between rows, so that each falls on a row.
  if (timeline.rows > 1)
    for (const Tick& tick : linear_ticks(0, static_cast<double>(timeline.rows - 1),
                                         static_cast<int>(std::min<std::size_t>(timeline.rows - 1, 12))))
      chart.canvas().text({kPlot.x - 10, row(static_cast<std::size_t>(tick.value)) + 5}, tick.label,
                          {.size = 16, .color = kFaintInk, .align = TextAlign::right});
  chart.draw_base();
  chart.commit();
}

}  // namespace driftmesh
