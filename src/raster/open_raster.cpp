#include "raster/open_raster.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "base/in_turns.hpp"
#include "driftmesh/error.hpp"
#include "raster/mosaic_rows.hpp"
#include "raster/nearest_values.hpp"
#include "raster/raster_source.hpp"
#include "raster/raster_stack.hpp"
#include "raster/read_tiles.hpp"
#include "raster/resample.hpp"

namespace driftmesh {
namespace {

constexpr double kMargin = 0.125;  // around the domain, of its size

Box widened(const Box& box) {
  const double more = kMargin * std::max(box.high.x - box.low.x, box.high.y - box.low.y);
  return {{box.low.x - more, box.low.y - more}, {box.high.x + more, box.high.y + more}};
}

/// Numbers of the values from `low` to `high` where the first value is `first`, and two more on both sides; of those
/// that the raster does not have, `beyond` on both sides.
std::pair<std::int64_t, std::int64_t> range_of(double low, double high, double first, double spacing,
                                               std::int64_t count, std::int64_t beyond) {
  const auto steps = [&](double x) { return std::clamp((x - first) / spacing, -1.0, static_cast<double>(count)); };
  return {std::max(static_cast<std::int64_t>(std::floor(steps(low))) - 2, -beyond),
          std::min(static_cast<std::int64_t>(std::ceil(steps(high))) + 2, count - 1 + beyond)};
}

/// The whole of a raster, with the half cells at its rim.
Box extent_of(const RasterFrame& f) {
  return {{f.first.x - f.dx / 2, f.first.y - f.dy / 2},
          {f.first.x + (static_cast<double>(f.columns) - 0.5) * f.dx,
           f.first.y + (static_cast<double>(f.rows) - 0.5) * f.dy}};
}

FramePart part_of(const RasterFrame& whole, const Box& window, std::int64_t beyond) {
  const auto [left, right] = range_of(window.low.x, window.high.x, whole.first.x, whole.dx, whole.columns, beyond);
  const auto [bottom, top] = range_of(window.low.y, window.high.y, whole.first.y, whole.dy, whole.rows, beyond);
  RasterFrame frame = whole;
  frame.first = {whole.first.x + static_cast<double>(left) * whole.dx,
                 whole.first.y + static_cast<double>(bottom) * whole.dy};
  frame.columns = right - left + 1;
  frame.rows = top - bottom + 1;
  return {left, bottom, frame};
}

TiledGrid read_window(RasterRows& rows, const Box& window, std::int64_t beyond = 0) {
  const auto [left, bottom, frame] = part_of(rows.frame(), window, beyond);
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

/// Where a domain is in the coordinates of a raster.
struct Placed {
  PlaceMap to_source;     // null: they are the same
  Box domain;             // with a margin
  Box window;             // the same in the raster's coordinates
  bool has_pole = false;  // these are longitudes and latitudes, and the domain is around a pole
};

/// Whether longitudes jump in an image of a domain, which is never so wide.
bool wraps(const Box& window) {
  return window.low.y > -91 && window.high.y < 91 && window.low.x > -370 && window.high.x < 370 &&
         window.high.x - window.low.x > 180;
}

/// Whether a pole is in an image of a domain, given that longitudes jump there: those of the rim have no gap.
bool has_pole(const Box& domain, const PlaceMap& to_source) {
  constexpr double kWidestGap = 90;
  std::vector<double> longitudes;
  for_each_on_rim(domain, [&](const Point& p) { longitudes.push_back(to_source(p).x); });
  std::ranges::sort(longitudes);
  double widest = longitudes.front() + 360 - longitudes.back();
  for (std::size_t i = 1; i < longitudes.size(); ++i) widest = std::max(widest, longitudes[i] - longitudes[i - 1]);
  return widest < kWidestGap;
}

/// Throws LimitError with the name of the file if its values are absurdly dense.
TiledGrid resampled(TiledGrid grid, const Placed& at, const Box& domain, const std::string& path) {
  try {
    return resample(GridRaster(std::move(grid)), at.to_source, domain, at.has_pole);
  } catch (const LimitError& error) {
    throw LimitError(path + ": " + error.what());
  }
}

Placed placed(const RasterRows& rows, const std::string& path, const RasterPlace& place) {
  if (!place.projection && rows.in_mercator())
    throw InputError(
        {path}, "is in Mercator's projection, whose meters are none, and the domain does not say where it is",
        "give the domain in degrees or in a UTM zone (GeoJSON, .shp), or reproject the raster with gdalwarp");
  Placed found;
  if (place.projection) found.to_source = rows.from_plane(*place.projection);
  found.domain = widened(place.domain);
  found.window = found.to_source ? image_of(found.domain, found.to_source) : found.domain;
  if (!found.to_source || !wraps(found.window)) return found;
  found.has_pole = has_pole(found.domain, found.to_source);
  if (found.has_pole)
    (found.window.high.y > 0 ? found.window.high.y : found.window.low.y) = found.window.high.y > 0 ? 90 : -90;
  return found;
}

[[noreturn]] void refuse_elsewhere(const std::string& path, const RasterPlace& place) {
  throw InputError({path}, "lies elsewhere than the domain",
                   place.projection ? "its coordinates must be those of the domain or name their system"
                                    : "its coordinates must be those of the domain, whose system is not known");
}

[[noreturn]] void refuse_without_values(const std::string& path) {
  throw InputError({path}, "has no value in or near the domain", "give one that covers it");
}

void refuse_wrapped(const std::string& path, const Placed& at) {
  if (at.to_source && wraps(at.window) && !at.has_pole)
    throw InputError({path}, "ends within the domain, where longitudes go once around the globe",
                     "give one whose longitudes count on there: gdalwarp -t_srs '+proj=longlat +lon_wrap=180'");
}

enum class Cover : unsigned char { kOutside, kWithout, kValue };

/// What a raster has at points, where those before it have no value.
void note_cover(const TiledGrid& grid, const Box& extent, const PlaceMap& to_source, std::span<const Point> points,
                std::vector<Cover>& covers) {
  // What is on a side of the raster is in the cell there, not in one beyond.
  const double dx = grid.frame().dx / 4, dy = grid.frame().dy / 4;
  const Box inside{{extent.low.x + dx, extent.low.y + dy}, {extent.high.x - dx, extent.high.y - dy}};
  for (std::size_t k = 0; k < points.size(); ++k) {
    if (covers[k] == Cover::kValue) continue;
    const Point q = to_source ? to_source(points[k]) : points[k];
    if (extent.contains(q))
      covers[k] = has_value_at(grid, {std::clamp(q.x, inside.low.x, inside.high.x),
                                      std::clamp(q.y, inside.low.y, inside.high.y)})
                      ? Cover::kValue
                      : Cover::kWithout;
  }
}

OpenedRaster opened(std::shared_ptr<const Raster> raster, const std::vector<Cover>& covers) {
  const auto count = [&](Cover what) { return static_cast<std::size_t>(std::ranges::count(covers, what)); };
  return {std::move(raster), count(Cover::kOutside), count(Cover::kWithout)};
}

// ---- Several rasters ---------------------------------------------------------------------------------------------

std::size_t threads_for(const std::vector<std::string>& paths, const RasterPlace& place) {
  return can_be_read_at_once(paths) ? place.threads : 1;
}

/// A raster that overlaps the domain.
struct NearTile {
  RasterTile tile;
  double spacing;               // the greater one, in the units of the domain
  std::optional<Point> center;  // the domain's, in its coordinates; absent: they are the same
};

/// The distances in the domain between the columns and between the rows of a raster around a place.
std::pair<double, double> spacings_in(const RasterFrame& frame, const Point& at, const PlaceMap& from_source) {
  if (!from_source) return {frame.dx, frame.dy};
  const Point here = from_source(at), east = from_source({at.x + frame.dx, at.y}),
              north = from_source({at.x, at.y + frame.dy});
  return {std::hypot(east.x - here.x, east.y - here.y), std::hypot(north.x - here.x, north.y - here.y)};
}

Box common_part(const Box& a, const Box& b) {
  return {{std::max(a.low.x, b.low.x), std::max(a.low.y, b.low.y)},
          {std::min(a.high.x, b.high.x), std::min(a.high.y, b.high.y)}};
}

PlaceMap map_to_plane(const RasterRows& rows, const RasterPlace& place) {
  return place.projection ? rows.to_plane(*place.projection) : nullptr;
}

/// None for one that does not overlap the domain.
std::optional<NearTile> near_tile(const std::string& path, const RasterPlace& place) {
  const std::unique_ptr<RasterRows> rows = open_raster_rows(path);
  const Placed at = placed(*rows, path, place);
  const Box extent = extent_of(rows->frame());
  if (!at.window.overlaps(extent)) return std::nullopt;
  refuse_wrapped(path, at);
  const auto [across, upward] =
      spacings_in(rows->frame(), common_part(extent, at.window).center(), map_to_plane(*rows, place));
  NearTile tile{{path, rows->frame()}, std::max(across, upward), {}};
  if (at.to_source) tile.center = at.to_source(place.domain.center());
  return tile;
}

std::vector<NearTile> near_tiles(const std::vector<std::string>& paths, const RasterPlace& place) {
  // What GDAL may do is set for all threads as long as one file is open.
  const std::unique_ptr<RasterRows> any = open_raster_rows(paths.front());
  std::vector<std::optional<NearTile>> found(paths.size());
  in_turns(paths.size(), threads_for(paths, place), [&](std::size_t k) { found[k] = near_tile(paths[k], place); });
  std::vector<NearTile> tiles;
  for (std::optional<NearTile>& tile : found)
    if (tile) tiles.push_back(std::move(*tile));
  if (tiles.empty()) refuse_elsewhere(paths.front(), place);
  return tiles;
}

bool in_one_system(const NearTile& a, const NearTile& b) {
  if (!a.center || !b.center) return !a.center && !b.center;
  const auto same = [](double x, double y) { return std::abs(x - y) <= 1e-9 * (1 + std::abs(x)); };
  return same(a.center->x, b.center->x) && same(a.center->y, b.center->y);
}

double count_in(const RasterFrame& frame) {
  return static_cast<double>(frame.columns) * static_cast<double>(frame.rows);
}

/// Neighbors in the list that are one grid, unless this would be mostly empty.
std::vector<std::vector<RasterTile>> mosaics_of(const std::vector<NearTile>& tiles) {
  constexpr double kMostEmpty = 8;  // as many points as the tiles have
  std::vector<std::vector<RasterTile>> mosaics;
  RasterFrame around;
  double points = 0;
  for (std::size_t k = 0; k < tiles.size(); ++k) {
    const RasterTile& tile = tiles[k].tile;
    bool joins = k > 0 && in_one_system(tiles[k - 1], tiles[k]) && on_one_grid(around, tile.frame);
    if (joins) {
      const RasterFrame both = frame_around(around, tile.frame);
      joins = count_in(both) <= kMostEmpty * (points + count_in(tile.frame));
      if (joins) around = both;
    }
    if (!joins) {
      mosaics.emplace_back();
      around = tile.frame;
      points = 0;
    }
    mosaics.back().push_back(tile);
    points += count_in(tile.frame);
  }
  return mosaics;
}

/// Where shares are not 0: they are beyond a side of their grid that has nothing else.
Box reach_of(const TiledGrid& shares) {
  constexpr double kUnbounded = std::numeric_limits<double>::infinity();
  const std::int64_t columns = shares.frame().columns, rows = shares.frame().rows;
  Box reach = box_of(shares.frame());
  for (std::int64_t i = 0; i < columns; ++i) {
    if (shares.at(i, 0) > 0) reach.low.y = -kUnbounded;
    if (shares.at(i, rows - 1) > 0) reach.high.y = kUnbounded;
  }
  for (std::int64_t j = 0; j < rows; ++j) {
    if (shares.at(0, j) > 0) reach.low.x = -kUnbounded;
    if (shares.at(columns - 1, j) > 0) reach.high.x = kUnbounded;
  }
  return reach;
}

/// The layer of a raster; none if it has no value near the domain. The last one needs no shares.
std::optional<RasterStack::Layer> read_layer(const std::vector<RasterTile>& tiles, const RasterPlace& place,
                                             double blend, bool is_last, std::vector<Cover>& covers) {
  std::vector<std::string> paths;
  for (const RasterTile& tile : tiles) paths.push_back(tile.path);
  const std::string& path = paths.front();
  MosaicRows rows(tiles);
  const Placed at = placed(rows, path, place);
  TiledGrid grid = can_be_read_at_once(paths)
                       ? read_tiles(tiles, rows.frame(), part_of(rows.frame(), at.window, 1), place.threads)
                       : read_window(rows, at.window, 1);
  note_cover(grid, extent_of(rows.frame()), at.to_source, place.points, covers);
  const PlaceMap from_source = map_to_plane(rows, place);
  const RasterFrame frame = grid.frame();
  const Box own = box_of(frame);
  const Box target = at.to_source ? common_part(at.domain, image_of(own, from_source)) : own;
  const auto in_domain = [&](TiledGrid values) {
    return at.to_source ? resampled(std::move(values), at, target, path) : std::move(values);
  };
  const std::int64_t missing = count_missing(grid);
  if (missing == frame.columns * frame.rows) return std::nullopt;
  const auto [across, upward] = spacings_in(frame, common_part(own, at.window).center(), from_source);
  std::optional<TiledGrid> shares;
  if (missing > 0 && !is_last) shares = shares_of(grid, across, upward, std::max({blend, across, upward}));
  fill_from_nearest(grid, across, upward);
  const auto values = std::make_shared<const GridRaster>(in_domain(std::move(grid)));
  if (!shares) return RasterStack::Layer{values, nullptr, {}};
  TiledGrid in_plane = in_domain(std::move(*shares));
  const Box reach = reach_of(in_plane);
  return RasterStack::Layer{values, std::make_shared<const GridRaster>(std::move(in_plane)), reach};
}

}  // namespace

OpenedRaster open_raster(const std::string& path, const RasterPlace& place) {
  const std::unique_ptr<RasterRows> rows = open_raster_rows(path);
  const Placed at = placed(*rows, path, place);
  refuse_wrapped(path, at);
  const Box extent = extent_of(rows->frame());
  if (!at.window.overlaps(extent)) refuse_elsewhere(path, place);
  TiledGrid grid = read_window(*rows, at.window);
  std::vector<Cover> covers(place.points.size(), Cover::kOutside);
  note_cover(grid, extent, at.to_source, place.points, covers);
  const std::int64_t values = grid.frame().columns * grid.frame().rows;
  const double width = grid.frame().dx * (at.to_source ? narrowing(at.window) : 1);
  if (fill_from_nearest(grid, width, grid.frame().dy) == values) refuse_without_values(path);
  if (at.to_source) grid = resampled(std::move(grid), at, at.domain, path);
  return opened(std::make_shared<const GridRaster>(std::move(grid)), covers);
}

OpenedRaster open_rasters(const std::vector<std::string>& paths, const RasterPlace& place, const Stacking& how) {
  if (paths.size() == 1) return open_raster(paths.front(), place);
  std::vector<NearTile> tiles = near_tiles(paths, place);
  if (how.finest_first) std::ranges::stable_sort(tiles, {}, &NearTile::spacing);
  std::vector<Cover> covers(place.points.size(), Cover::kOutside);
  std::vector<RasterStack::Layer> layers;
  const std::vector<std::vector<RasterTile>> mosaics = mosaics_of(tiles);
  for (const std::vector<RasterTile>& mosaic : mosaics) {
    const bool is_last = &mosaic == &mosaics.back();
    if (auto layer = read_layer(mosaic, place, how.blend, is_last, covers)) layers.push_back(std::move(*layer));
    if (!layers.empty() && !layers.back().share) break;  // what is below is not seen
  }
  if (layers.empty()) refuse_without_values(paths.front());
  return opened(std::make_shared<const RasterStack>(std::move(layers)), covers);
}

}  // namespace driftmesh
