#include "raster/mosaic_rows.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "driftmesh/error.hpp"
#include "raster/raster_source.hpp"

namespace driftmesh {
namespace {

constexpr double kOff = 0.01;  // spacings

/// By how many spacings `first` is behind `from`.
std::int64_t steps_from(double from, double first, double spacing) {
  return static_cast<std::int64_t>(std::round((first - from) / spacing));
}

bool on_one_line(double first_a, double first_b, double a, double b, std::int64_t count) {
  if (std::abs(a - b) * static_cast<double>(count) > kOff * a) return false;
  const double steps = (first_b - first_a) / a;
  return std::abs(steps) < 0x1p40 && std::abs(steps - std::round(steps)) <= kOff;
}

}  // namespace

bool on_one_grid(const RasterFrame& a, const RasterFrame& b) {
  return on_one_line(a.first.x, b.first.x, a.dx, b.dx, std::max(a.columns, b.columns)) &&
         on_one_line(a.first.y, b.first.y, a.dy, b.dy, std::max(a.rows, b.rows));
}

RasterFrame frame_around(const RasterFrame& a, const RasterFrame& b) {
  const std::int64_t left = steps_from(a.first.x, b.first.x, a.dx), bottom = steps_from(a.first.y, b.first.y, a.dy);
  const std::int64_t first_column = std::min<std::int64_t>(left, 0), first_row = std::min<std::int64_t>(bottom, 0);
  RasterFrame both = a;
  both.first = {a.first.x + static_cast<double>(first_column) * a.dx,
                a.first.y + static_cast<double>(first_row) * a.dy};
  both.columns = std::max(a.columns, left + b.columns) - first_column;
  both.rows = std::max(a.rows, bottom + b.rows) - first_row;
  return both;
}

Box box_of(const RasterFrame& frame) {
  return {frame.first,
          {frame.first.x + static_cast<double>(frame.columns - 1) * frame.dx,
           frame.first.y + static_cast<double>(frame.rows - 1) * frame.dy}};
}

MosaicRows::MosaicRows(std::vector<RasterTile> tiles) : frame_(tiles.front().frame) {
  for (const RasterTile& tile : tiles) frame_ = frame_around(frame_, tile.frame);
  any_ = open_raster_rows(tiles.front().path);
  for (RasterTile& tile : tiles) {
    const Point first = tile.frame.first;
    parts_.push_back({std::move(tile), steps_from(frame_.first.x, first.x, frame_.dx),
                      steps_from(frame_.first.y, first.y, frame_.dy)});
  }
}

void MosaicRows::read(std::int64_t j, std::int64_t first, std::span<float> values) {
  std::ranges::fill(values, std::numeric_limits<float>::quiet_NaN());
  for (Part& part : parts_) {
    const RasterFrame& frame = part.tile.frame;
    const std::int64_t row = j - part.bottom;
    const std::int64_t begin = std::max(first, part.left),
                       end = std::min(first + static_cast<std::int64_t>(values.size()), part.left + frame.columns);
    if (part.done || row >= frame.rows || begin >= end) continue;
    if (row < 0) {
      if (part.open) part.open->finish();
      part.open.reset();
      part.done = true;
      continue;
    }
    if (!part.open) part.open = open_raster_rows(part.tile.path);
    row_.resize(static_cast<std::size_t>(end - begin));
    part.open->read(row, begin - part.left, row_);
    for (std::int64_t i = begin; i < end; ++i)
      if (float& value = values[static_cast<std::size_t>(i - first)]; std::isnan(value))
        value = row_[static_cast<std::size_t>(i - begin)];
  }
}

void MosaicRows::finish() {
  for (Part& part : parts_)
    if (part.open) part.open->finish();
}

std::unique_ptr<RasterRows> open_mosaic(const std::vector<std::string>& paths) {
  if (paths.size() == 1) return open_raster_rows(paths.front());
  std::vector<RasterTile> tiles;
  DomainSystem first;
  for (const std::string& path : paths) {
    const std::unique_ptr<RasterRows> rows = open_raster_rows(path);
    const DomainSystem system = rows->domain_system();
    tiles.push_back({path, rows->frame()});
    if (tiles.size() == 1) first = system;
    const RasterTile& own = tiles.front();
    if (system.in_degrees != first.in_degrees || system.projection != first.projection ||
        !on_one_grid(own.frame, tiles.back().frame))
      throw InputError({path}, "is not on one grid with " + own.path + ", so that they have no outline in common",
                       "bring them onto one with gdalwarp, or name the raster that has the outline");
  }
  return std::make_unique<MosaicRows>(std::move(tiles));
}

}  // namespace driftmesh
