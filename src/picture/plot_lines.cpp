#include "picture/plot_lines.hpp"

#include <cairo.h>

namespace driftmesh {

namespace {
constexpr std::size_t kLinesOfPath = 512;
}

LineBatch::LineBatch(Canvas& canvas, double width, const Rgb& color, double opacity)
    : canvas_(canvas), width_(width), color_(color), opacity_(opacity) {}

void LineBatch::add(const Point& from, const Point& to) {
  cairo_move_to(canvas_.cairo(), from.x, from.y);
  cairo_line_to(canvas_.cairo(), to.x, to.y);
  if (++waiting_ == kLinesOfPath) flush();
}

void LineBatch::flush() {
  if (waiting_ == 0) return;
  cairo_t* const cairo = canvas_.cairo();
  canvas_.set_color(color_, opacity_);
  cairo_set_line_width(cairo, width_);
  cairo_set_line_cap(cairo, CAIRO_LINE_CAP_ROUND);
  cairo_stroke(cairo);
  waiting_ = 0;
}

}  // namespace driftmesh
