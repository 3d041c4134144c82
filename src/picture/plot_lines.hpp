#pragma once

#include <array>
#include <cstddef>

#include "picture/plot_canvas.hpp"

namespace driftmesh {

/// Strokes many separate lines with one pen, a few hundred per path: cairo is slow with paths of one line and with
/// paths of very many.
class LineBatch {
 public:
  LineBatch(Canvas& canvas, double width, const Rgb& color, double opacity = 1);
  ~LineBatch() { flush(); }
  LineBatch(const LineBatch&) = delete;
  LineBatch& operator=(const LineBatch&) = delete;

  void add(const Point& from, const Point& to);
  void flush();

 private:
  Canvas& canvas_;
  double width_;
  Rgb color_;
  double opacity_;
  std::size_t waiting_ = 0;
};

}  // namespace driftmesh
