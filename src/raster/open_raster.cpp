#include "raster/open_raster.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <utility>
#include <vector>

#include "base/file_bytes.hpp"
#include "driftmesh/error.hpp"
#include "gis/raster_file.hpp"
#include "raster/ascii_grid.hpp"
#include "raster/nearest_values.hpp"
#include "raster/resample.hpp"

namespace driftmesh {
namespace {

constexpr double kMargin = 0.125;  // around the domain, of its size

Box widened(const Box& box) {
  const double more = kMargin * std::max(box.high.x - box.low.x, box.high.y - box.low.y);
  return {{box.low.x - more, box.low.y - more}, {box.high.x + more, box.high.y + more}};
}

/// Numbers of the values from `low` to `high` where the first value is `first`, and two more on both sides.
std::pair<std::int64_t, std::int64_t> range_of(double low, double high, double first, double spacing,
                                               std::int64_t count) {
  const auto steps = [&](double x) { return std::clamp((x - first) / spacing, -1.0, static_cast<double>(count)); };
  return {std::max<std::int64_t>(static_cast<std::int64_t>(std::floor(steps(low))) - 2, 0),
          std::min<std::int64_t>(static_cast<std::int64_t>(std::ceil(steps(high))) + 2, count - 1)};
}

/// The whole of a raster, with the half cells at its rim.
Box extent_of(const RasterFrame& f) {
  return {{f.first.x - f.dx / 2, f.first.y - f.dy / 2},
          {f.first.x + (static_cast<double>(f.columns) - 0.5) * f.dx,
           f.first.y + (static_cast<double>(f.rows) - 0.5) * f.dy}};
}

TiledGrid read_window(RasterRows& rows, const Box& window) {
  const RasterFrame& whole = rows.frame();
  const auto [left, right] = range_of(window.low.x, window.high.x, whole.first.x, whole.dx, whole.columns);
  const auto [bottom, top] = range_of(window.low.y, window.high.y, whole.first.y, whole.dy, whole.rows);
  RasterFrame frame = whole;
  frame.first = {whole.first.x + static_cast<double>(left) * whole.dx,
                 whole.first.y + static_cast<double>(bottom) * whole.dy};
  frame.columns = right - left + 1;
  frame.rows = top - bottom + 1;
  TiledGrid grid(frame);
  std::vector<float> row(static_cast<std::size_t>(frame.columns));
  for (std::int64_t j = frame.rows - 1; j >= 0; --j) {
    rows.read(bottom + j, left, row);
    for (std::int64_t i = 0; i < frame.columns; ++i) grid.set(i, j, row[static_cast<std::size_t>(i)]);
  }
  rows.finish();
  return grid;
}

bool has_value_at(const TiledGrid& grid, const Point& p) {
  const RasterFrame& f = grid.frame();
  const auto nearest = [](double x, double first, double spacing, std::int64_t count) {
    return static_cast<std::int64_t>(
        std::clamp(std::floor((x - first) / spacing + 0.5), 0.0, static_cast<double>(count - 1)));
  };
  return !std::isnan(grid.at(nearest(p.x, f.first.x, f.dx, f.columns), nearest(p.y, f.first.y, f.dy, f.rows)));
}

/// How much shorter the way from column to column is than the coordinates say, in degrees if they could be some.
double narrowing(const Box& window) {
  if (window.low.y < -90 || window.high.y > 90) return 1;
  return std::max(std::cos((window.low.y + window.high.y) / 2 * std::numbers::pi / 180), 0.01);
}

/// Whether longitudes jump in an image of a domain, which is never so wide.
bool wraps(const Box& window) {
  return window.low.y > -91 && window.high.y < 91 && window.low.x > -370 && window.high.x < 370 &&
         window.high.x - window.low.x > 180;
}

/// Throws LimitError with the name of the file if its values are absurdly dense.
std::shared_ptr<const Raster> resampled(const Raster& raster, const PlaceMap& to_source, const Box& domain,
                                        const std::string& path) {
  try {
    return std::make_shared<const Raster>(resample(raster, to_source, domain));
  } catch (const LimitError& error) {
    throw LimitError(path + ": " + error.what());
  }
}

}  // namespace

OpenedRaster open_raster(const std::string& path, const RasterPlace& place) {
  std::optional<FileBytes> bytes;
  std::unique_ptr<RasterRows> rows;
  if (std::filesystem::path(path).extension() == ".asc")
    rows = std::make_unique<AsciiGrid>(path, bytes.emplace(path).view());
  else
    rows = open_raster_file(path);
  if (!place.zone && rows->in_mercator())
    throw InputError(
        {path}, "is in Mercator's projection, whose meters are none, and the domain does not say where it is",
        "give the domain in degrees or in a UTM zone (GeoJSON, .shp), or reproject the raster with gdalwarp");
  PlaceMap to_source;
  if (place.zone) to_source = rows->from_zone(*place.zone);
  const Box domain = widened(place.domain);
  const Box window = to_source ? image_of(domain, to_source) : domain;
  if (to_source && wraps(window))
    throw InputError({path}, "ends within the domain, where longitudes go once around the globe",
                     "give one whose longitudes count on there: gdalwarp -t_srs '+proj=longlat +lon_wrap=180'");
  const Box extent = extent_of(rows->frame());
  if (!window.overlaps(extent))
    throw InputError({path}, "lies elsewhere than the domain",
                     place.zone ? "its coordinates must be those of the domain or name their system"
                                : "its coordinates must be those of the domain, whose system is not known");
  TiledGrid grid = read_window(*rows, window);
  OpenedRaster opened;
  for (const Point& p : place.points) {
    const Point q = to_source ? to_source(p) : p;
    if (!extent.contains(q))
      ++opened.outside;
    else if (!has_value_at(grid, q))
      ++opened.without;
  }
  const std::int64_t values = grid.frame().columns * grid.frame().rows;
  const double width = grid.frame().dx * (to_source ? narrowing(window) : 1);
  if (fill_from_nearest(grid, width, grid.frame().dy) == values)
    throw InputError({path}, "has no value in or near the domain", "give one that covers it");
  opened.raster = std::make_shared<const Raster>(std::move(grid));
  if (to_source) opened.raster = resampled(*opened.raster, to_source, domain, path);
  return opened;
}

}  // namespace driftmesh
