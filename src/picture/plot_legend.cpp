#include "picture/plot_legend.hpp"

#include <cairo.h>

#include <algorithm>
#include <cmath>

namespace driftmesh {
namespace {

constexpr double kTickRoom = 46;  // units, left of the bar
constexpr double kBarWidth = 14;
constexpr double kHistogramWidth = 72;

// Draws the title and the notes below it, and returns the top of what follows.
double draw_legend_title(Canvas& canvas, const PlotFrame& frame, const std::string& title,
                         const std::vector<std::string>& notes) {
  const double u = frame.unit();
  double baseline = frame.legend().y + 10 * u;
  canvas.text({frame.legend().x, baseline}, title, {.size = 12.5 * u, .bold = true});
  for (const std::string& note : notes)
    canvas.text({frame.legend().x, baseline += 16 * u}, note, {.size = 11.5 * u, .color = kFaintInk});
  return baseline + (notes.empty() ? 14 : 16) * u;
}

void fill_bar(Canvas& canvas, const PixelRect& rect) {
  cairo_pattern_t* const gradient = cairo_pattern_create_linear(0, rect.y + rect.height, 0, rect.y);
  for (int i = 0; i <= 32; ++i) {
    const Rgb color = viridis(i / 32.0);
    cairo_pattern_add_color_stop_rgb(gradient, i / 32.0, color.red, color.green, color.blue);
  }
  cairo_set_source(canvas.cairo(), gradient);
  cairo_rectangle(canvas.cairo(), rect.x, rect.y, rect.width, rect.height);
  cairo_fill(canvas.cairo());
  cairo_pattern_destroy(gradient);
}

void draw_histogram(Canvas& canvas, const PixelRect& room, const std::vector<std::size_t>& counts) {
  const std::size_t most = counts.empty() ? 0 : *std::max_element(counts.begin(), counts.end());
  if (most == 0) return;
  const double step = room.height / static_cast<double>(counts.size());
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (counts[i] == 0) continue;
    const double share = static_cast<double>(counts[i]) / static_cast<double>(most);
    const double gap = std::min(1.0, 0.15 * step);
    const double y = room.y + room.height - static_cast<double>(i + 1) * step;
    const Rgb color = viridis((static_cast<double>(i) + 0.5) / static_cast<double>(counts.size()));
    canvas.fill_rect({room.x, y + gap / 2, std::max(share * room.width, 1.0), step - gap}, color);
  }
}

}  // namespace

ColorBar logarithmic_bar(const std::string& title, double low, double high) {
  ColorBar bar;
  bar.title = title;
  bar.notes = {"log scale"};
  bar.low = low;
  bar.high = high;
  bar.ticks = logarithmic_ticks(std::pow(10, low), std::pow(10, high), 7);
  for (Tick& tick : bar.ticks) tick.value = std::log10(tick.value);
  return bar;
}

std::vector<std::size_t> histogram_of(const std::vector<float>& values, double low, double high) {
  constexpr std::size_t kBins = 60;
  std::vector<std::size_t> counts(kBins, 0);
  for (const float value : values) {
    const double place = std::clamp((value - low) / (high - low), 0.0, 1.0);
    ++counts[std::min(static_cast<std::size_t>(place * kBins), kBins - 1)];
  }
  return counts;
}

void draw_color_bar(Canvas& canvas, const PlotFrame& frame, const ColorBar& bar) {
  if (!frame.has_legend()) return;
  const double u = frame.unit();
  const double top = draw_legend_title(canvas, frame, bar.title, bar.notes);
  const double height = std::clamp(frame.legend().y + frame.legend().height - top, 80 * u, 380 * u);
  const PixelRect rect{frame.legend().x + kTickRoom * u, top, kBarWidth * u, height};
  fill_bar(canvas, rect);
  for (const Tick& tick : bar.ticks) {
    const double y = rect.y + rect.height * (1 - (tick.value - bar.low) / (bar.high - bar.low));
    canvas.line({rect.x - 4 * u, y}, {rect.x, y}, 0.8 * u, kFaintInk);
    canvas.text({rect.x - 7 * u, y + 4 * u}, tick.label,
                {.size = 11.5 * u, .color = kFaintInk, .align = TextAlign::kRight});
  }
  draw_histogram(canvas, {rect.x + rect.width + 3 * u, rect.y, kHistogramWidth * u, rect.height}, bar.histogram);
}

void draw_swatches(Canvas& canvas, const PlotFrame& frame, const std::string& title,
                   const std::vector<Swatch>& swatches) {
  if (!frame.has_legend()) return;
  const double u = frame.unit();
  const double line = 19 * u;
  double y = draw_legend_title(canvas, frame, title, {});
  const double bottom = std::max(frame.legend().y + frame.legend().height, y + 3 * line);
  const auto room = static_cast<std::size_t>(std::max((bottom - y) / line, 1.0));
  const std::size_t shown = swatches.size() <= room ? swatches.size() : room - 1;
  for (std::size_t i = 0; i < shown; ++i, y += line) {
    canvas.fill_rect({frame.legend().x, y, 22 * u, 12 * u}, swatches[i].color);
    canvas.text({frame.legend().x + 29 * u, y + 10.5 * u}, swatches[i].label, {.size = 12 * u});
  }
  if (shown < swatches.size())
    canvas.text({frame.legend().x, y + 10.5 * u}, "and " + grouped_digits(swatches.size() - shown) + " more",
                {.size = 12 * u, .color = kFaintInk});
}

}  // namespace driftmesh
