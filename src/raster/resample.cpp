#include "raster/resample.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace driftmesh {
namespace {

constexpr std::int64_t kStep = 16;

/// At most the spacings of the raster, as they are around a place.
double spacing_at(const Point& p, const RasterFrame& frame, const PlaceMap& to_source, double step) {
  const Point here = to_source(p), east = to_source({p.x + step, p.y}), north = to_source({p.x, p.y + step});
  const double columns = std::hypot(east.x - here.x, north.x - here.x) / frame.dx;  // columns in a step
  const double rows = std::hypot(east.y - here.y, north.y - here.y) / frame.dy;
  return std::exp2(std::floor(std::log2(step / std::max(columns, rows))));
}

RasterFrame frame_over(const Box& box, double spacing) {
  RasterFrame frame;
  frame.dx = frame.dy = spacing;
  frame.first = {std::floor(box.low.x / spacing) * spacing, std::floor(box.low.y / spacing) * spacing};
  // More than any raster may have; also where the file's spacing makes it infinite or not a number.
  constexpr double kMost = 0x1p40;
  const auto count = [](double steps) {
    return 1 + static_cast<std::int64_t>(steps <= kMost ? std::ceil(steps) : kMost);
  };
  frame.columns = count((box.high.x - frame.first.x) / spacing);
  frame.rows = count((box.high.y - frame.first.y) / spacing);
  return frame;
}

Point between(const Point& a, const Point& b, double t) {
  return {a.x + (b.x - a.x) * t, a.y + (b.y - a.y) * t};
}

}  // namespace

TiledGrid resample(const GridRaster& source, const PlaceMap& to_source, const Box& box) {
  const double size = std::max(box.high.x - box.low.x, box.high.y - box.low.y);
  TiledGrid grid(frame_over(box, spacing_at(box.center(), source.frame(), to_source, size / 256)));
  const RasterFrame& frame = grid.frame();
  const std::int64_t across = (frame.columns + kStep - 1) / kStep + 1;
  std::vector<Point> below(static_cast<std::size_t>(across)), above(below);
  const auto map_row = [&](std::int64_t j, std::vector<Point>& places) {
    for (std::int64_t k = 0; k < across; ++k) places[static_cast<std::size_t>(k)] = to_source(grid.point(k * kStep, j));
  };
  map_row(0, above);
  for (std::int64_t j = 0; j < frame.rows; ++j) {
    if (j % kStep == 0) {
      std::swap(below, above);
      map_row(j + kStep, above);
    }
    const double t = static_cast<double>(j % kStep) / kStep;
    for (std::int64_t i = 0; i < frame.columns; ++i) {
      const auto k = static_cast<std::size_t>(i / kStep);
      const double s = static_cast<double>(i % kStep) / kStep;
      const Point place = between(between(below[k], below[k + 1], s), between(above[k], above[k + 1], s), t);
      grid.set(i, j, static_cast<float>(source.at(place)));
    }
  }
  return grid;
}

Box image_of(const Box& box, const PlaceMap& map) {
  constexpr int kParts = 64;
  Box image;
  for (int k = 0; k <= kParts; ++k) {
    const Point p = between(box.low, box.high, static_cast<double>(k) / kParts);
    for (const Point& q : {Point{p.x, box.low.y}, {p.x, box.high.y}, {box.low.x, p.y}, {box.high.x, p.y}})
      image.extend(map(q));
  }
  const double more = 0.01 * std::max(image.high.x - image.low.x, image.high.y - image.low.y);
  return {{image.low.x - more, image.low.y - more}, {image.high.x + more, image.high.y + more}};
}

}  // namespace driftmesh
