#include "raster/resample.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace driftmesh {
namespace {

/// At most the spacings of the raster, as they are around a place; `jumps`: that of its rows.
double spacing_at(const Point& p, const RasterFrame& frame, const PlaceMap& to_source, double step, bool jumps) {
  const Point here = to_source(p), east = to_source({p.x + step, p.y}), north = to_source({p.x, p.y + step});
  const double columns = std::hypot(east.x - here.x, north.x - here.x) / frame.dx;  // columns in a step
  const double rows = std::hypot(east.y - here.y, north.y - here.y) / frame.dy;
  return std::exp2(std::floor(std::log2(step / (jumps ? rows : std::max(columns, rows)))));
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

TiledGrid resample(const GridRaster& source, const PlaceMap& to_source, const Box& box, bool jumps) {
  const std::int64_t between_asked = jumps ? 1 : 16;
  const double size = std::max(box.high.x - box.low.x, box.high.y - box.low.y);
  TiledGrid grid(frame_over(box, spacing_at(box.center(), source.frame(), to_source, size / 256, jumps)));
  const RasterFrame& frame = grid.frame();
  const std::int64_t across = (frame.columns + between_asked - 1) / between_asked + 1;
  std::vector<Point> below(static_cast<std::size_t>(across)), above(below);
  const auto map_row = [&](std::int64_t j, std::vector<Point>& places) {
    for (std::int64_t k = 0; k < across; ++k)
      places[static_cast<std::size_t>(k)] = to_source(grid.point(k * between_asked, j));
  };
  map_row(0, above);
  for (std::int64_t j = 0; j < frame.rows; ++j) {
    if (j % between_asked == 0) {
      std::swap(below, above);
      map_row(j + between_asked, above);
    }
    const double t = static_cast<double>(j % between_asked) / static_cast<double>(between_asked);
    for (std::int64_t i = 0; i < frame.columns; ++i) {
      const auto k = static_cast<std::size_t>(i / between_asked);
      const double s = static_cast<double>(i % between_asked) / static_cast<double>(between_asked);
      const Point place = between(between(below[k], below[k + 1], s), between(above[k], above[k + 1], s), t);
      grid.set(i, j, static_cast<float>(source.at(place)));
    }
  }
  return grid;
}

Box image_of(const Box& box, const PlaceMap& map) {
  Box image;
  for_each_on_rim(box, [&](const Point& p) { image.extend(map(p)); });
  const double more = 0.01 * std::max(image.high.x - image.low.x, image.high.y - image.low.y);
  return {{image.low.x - more, image.low.y - more}, {image.high.x + more, image.high.y + more}};
}

}  // namespace driftmesh
