#include "raster/read_tiles.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <string_view>

#include "base/in_turns.hpp"
#include "base/letter_case.hpp"
#include "raster/raster_source.hpp"

namespace driftmesh {
namespace {

/// Columns and rows of a grid, without the last ones.
struct Range {
  std::int64_t left, bottom, right, top;

  [[nodiscard]] bool overlaps(const Range& other) const {
    return left < other.right && other.left < right && bottom < other.top && other.bottom < top;
  }
};

/// Where a tile is in the part of the frame.
Range range_of(const RasterTile& tile, const RasterFrame& around, const FramePart& part) {
  const auto steps = [](double from, double to, double spacing) { return std::llround((to - from) / spacing); };
  const std::int64_t left = steps(around.first.x, tile.frame.first.x, around.dx) - part.left,
                     bottom = steps(around.first.y, tile.frame.first.y, around.dy) - part.bottom;
  return {left, bottom, left + tile.frame.columns, bottom + tile.frame.rows};
}

/// A tile is read after those before it that it overlaps: its turn.
std::vector<std::size_t> turns_of(const std::vector<Range>& ranges) {
  std::vector<std::size_t> turns(ranges.size(), 0);
  for (std::size_t k = 0; k < ranges.size(); ++k)
    for (std::size_t j = 0; j < k; ++j)
      if (ranges[j].overlaps(ranges[k])) turns[k] = std::max(turns[k], turns[j] + 1);
  return turns;
}

void fill_with(float value, TiledGrid& grid) {
  for (std::int64_t j = 0; j < grid.frame().rows; ++j)
    for (std::int64_t i = 0; i < grid.frame().columns; ++i) grid.set(i, j, value);
}

/// Sets what has no value yet.
void read_into(TiledGrid& grid, const RasterTile& tile, const Range& range) {
  const std::int64_t first = std::max<std::int64_t>(range.left, 0), end = std::min(range.right, grid.frame().columns);
  const std::int64_t low = std::max<std::int64_t>(range.bottom, 0), high = std::min(range.top, grid.frame().rows);
  if (first >= end || low >= high) return;
  const std::unique_ptr<RasterRows> rows = open_raster_rows(tile.path);
  std::vector<float> values(static_cast<std::size_t>(end - first));
  for (std::int64_t j = high - 1; j >= low; --j) {
    rows->read(j - range.bottom, first - range.left, values);
    for (std::int64_t i = first; i < end; ++i)
      if (std::isnan(grid.at(i, j))) grid.set(i, j, values[static_cast<std::size_t>(i - first)]);
  }
  rows->finish();
}

}  // namespace

TiledGrid read_tiles(const std::vector<RasterTile>& tiles, const RasterFrame& around, const FramePart& part,
                     std::size_t threads) {
  TiledGrid grid(part.part);
  fill_with(std::numeric_limits<float>::quiet_NaN(), grid);
  std::vector<Range> ranges;
  for (const RasterTile& tile : tiles) ranges.push_back(range_of(tile, around, part));
  const std::vector<std::size_t> turns = turns_of(ranges);
  for (std::size_t turn = 0, left = tiles.size(); left > 0; ++turn) {
    std::vector<std::size_t> now;
    for (std::size_t k = 0; k < tiles.size(); ++k)
      if (turns[k] == turn) now.push_back(k);
    in_turns(now.size(), threads, [&](std::size_t i) { read_into(grid, tiles[now[i]], ranges[now[i]]); });
    left -= now.size();
  }
  return grid;
}

bool can_be_read_at_once(const std::vector<std::string>& paths) {
  static constexpr std::array<std::string_view, 3> kKinds{".tif", ".tiff", ".asc"};
  return std::ranges::all_of(paths, [](const std::string& path) {
    const std::string extension = lower_case(std::filesystem::path(path).extension().string());
    return std::ranges::find(kKinds, extension) != kKinds.end();
  });
}

}  // namespace driftmesh
