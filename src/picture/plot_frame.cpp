#include "picture/plot_frame.hpp"

#include <cairo.h>

#include <algorithm>
#include <cmath>

#include "picture/plot_scale.hpp"

namespace driftmesh {
namespace {

// Margins in units.
constexpr double kTopMargin = 78;
constexpr double kRightMargin = 24;
constexpr double kBottomMargin = 40;
constexpr double kLegendWidth = 160;
constexpr double kTickFont = 11.5;
constexpr double kTickDistance = 90;

Box with_extent(Box box) {
  if (!(box.low.x <= box.high.x && box.low.y <= box.high.y)) box = {{0, 0}, {1, 1}};
  const double size = std::max(box.high.x - box.low.x, box.high.y - box.low.y);
  const double least = size > 0 ? 1e-6 * size : std::max({std::fabs(box.low.x), std::fabs(box.low.y), 1.0});
  if (box.high.x - box.low.x < least) box.low.x -= least / 2, box.high.x += least / 2;
  if (box.high.y - box.low.y < least) box.low.y -= least / 2, box.high.y += least / 2;
  return box;
}

// Space for the labels of the y axis, in units; digits of a sans-serif font are about 0.64 of its size wide.
double left_margin(const Box& shown, double height) {
  std::size_t longest = 0;
  for (const Tick& tick : linear_ticks(shown.low.y, shown.high.y, static_cast<int>(height)))
    longest = std::max(longest, tick.label.size());
  return std::max(62.0, 24 + 0.64 * kTickFont * static_cast<double>(longest));
}

}  // namespace

PlotFrame::PlotFrame(const Box& shown, int width, int height, bool wants_legend)
    : width_(width), height_(height), unit_(std::clamp(width / 1000.0, 0.6, 4.0)), shown_(with_extent(shown)) {
  left_ = left_margin(shown_, 12) * unit_;
  const double inner = width_ - left_ - kRightMargin * unit_;
  const double legend = wants_legend && inner >= 2 * kLegendWidth * unit_ ? kLegendWidth * unit_ : 0;
  const double room_x = inner - legend;
  const double aspect = (shown_.high.y - shown_.low.y) / (shown_.high.x - shown_.low.x);
  const double margins_y = (kTopMargin + kBottomMargin) * unit_;
  if (height_ == 0)
    height_ =
        std::max(static_cast<int>(std::lround(margins_y + std::clamp(aspect, 0.3, 1.4) * room_x)), Canvas::kSmallest);
  const double room_y = height_ - margins_y;
  scale_ = std::min(room_x / (shown_.high.x - shown_.low.x), room_y / (shown_.high.y - shown_.low.y));
  plot_.width = std::max(std::floor((shown_.high.x - shown_.low.x) * scale_), 1.0);
  plot_.height = std::max(std::floor((shown_.high.y - shown_.low.y) * scale_), 1.0);
  plot_.x = std::round(left_ + (room_x - plot_.width) / 2);
  plot_.y = std::round(kTopMargin * unit_ + (room_y - plot_.height) / 2);
  legend_ = {plot_.x + plot_.width + kRightMargin * unit_, plot_.y, legend, plot_.height};
}

void PlotFrame::draw_title(Canvas& canvas, const std::string& title, const std::string& subtitle) const {
  const double room = width_ - left_ - kRightMargin * unit_;
  TextStyle large{.size = 20 * unit_, .bold = true};
  large.size *= std::min(1.0, room / std::max(canvas.text_width(title, large), 1.0));
  canvas.text({left_, 34 * unit_}, title, large);
  const TextStyle small{.size = 13 * unit_, .color = kFaintInk};
  std::string shown = subtitle;
  while (canvas.text_width(shown, small) > room) {
    const std::size_t last = shown.rfind("   ");
    shown.resize(last == std::string::npos ? 0 : last);
  }
  canvas.text({left_, 56 * unit_}, shown, small);
}

void PlotFrame::draw_axes(Canvas& canvas) const {
  const TextStyle below{.size = kTickFont * unit_, .color = kFaintInk, .align = TextAlign::kCenter};
  const TextStyle left{.size = kTickFont * unit_, .color = kFaintInk, .align = TextAlign::kRight};
  const double bottom = plot_.y + plot_.height + 6 * unit_;
  const double side = plot_.x - 6 * unit_;
  const double tick = 4 * unit_;
  const double thin = 0.8 * unit_;
  for (const Tick& at :
       linear_ticks(shown_.low.x, shown_.high.x, static_cast<int>(plot_.width / (kTickDistance * unit_)))) {
    const double x = to_pixels({at.value, shown_.low.y}).x;
    canvas.line({x, bottom}, {x, bottom + tick}, thin, kFaintInk);
    canvas.text({x, bottom + tick + 13 * unit_}, at.label, below);
  }
  for (const Tick& at :
       linear_ticks(shown_.low.y, shown_.high.y, static_cast<int>(plot_.height / (kTickDistance * unit_)))) {
    const double y = to_pixels({shown_.low.x, at.value}).y;
    canvas.line({side - tick, y}, {side, y}, thin, kFaintInk);
    canvas.text({side - tick - 3 * unit_, y + 4 * unit_}, at.label, left);
  }
}

void PlotFrame::begin_clip(Canvas& canvas) const {
  cairo_save(canvas.cairo());
  cairo_rectangle(canvas.cairo(), plot_.x, plot_.y, plot_.width, plot_.height);
  cairo_clip(canvas.cairo());
}

void PlotFrame::end_clip(Canvas& canvas) {
  cairo_restore(canvas.cairo());
}

}  // namespace driftmesh
