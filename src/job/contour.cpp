#include "job/contour.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "base/key_error.hpp"
#include "base/key_text.hpp"
#include "driftmesh/error.hpp"
#include "geojson/each_point.hpp"
#include "geojson/read_input.hpp"
#include "geometry/box.hpp"
#include "gis/vector_file.hpp"
#include "job/keys.hpp"
#include "job/value.hpp"
#include "raster/level_outline.hpp"
#include "raster/mosaic_rows.hpp"

namespace driftmesh::job {
namespace {

/// The points of a raster that are domain or may bound it.
struct Window {
  RasterFrame frame;
  std::int64_t left = 0, bottom = 0;  // column and row of its first point
};

Window window_of(const RasterFrame& whole, const std::vector<double>& limits) {
  Window window{whole};
  if (limits.empty()) return window;
  const auto cut = [](double low, double high, double& first, double spacing, std::int64_t& count) {
    const auto steps = [&](double x) { return std::clamp((x - first) / spacing, -1.0, static_cast<double>(count)); };
    const auto begin = std::max<std::int64_t>(static_cast<std::int64_t>(std::ceil(steps(low))), 0);
    const auto last = std::min(static_cast<std::int64_t>(std::floor(steps(high))), count - 1);
    first += static_cast<double>(begin) * spacing;
    count = std::max<std::int64_t>(last - begin + 1, 0);
    return begin;
  };
  RasterFrame& frame = window.frame;
  window.left = cut(limits[0], limits[2], frame.first.x, frame.dx, frame.columns);
  window.bottom = cut(limits[1], limits[3], frame.first.y, frame.dy, frame.rows);
  return window;
}

/// An outline passes between values.
void refuse_small(const Window& window, const RasterFrame& whole, const Request::Input& input,
                  const std::string& file) {
  if (window.frame.columns > 1 && window.frame.rows > 1) return;
  if (input.contour_box.empty())
    throw InputError({file}, "has less than two rows or columns, and no outline passes between them",
                     "give a raster with more");
  const Box box = box_of(whole);
  throw Keyed<InputError>(
      KeyText::of(
          "{}: has less than two rows or columns within {}; its values, from west to east, are at {} to {}, and "
          "from south to north at {} to {}",
          file, KeyText::key("input.contour-box"), shortest_text(box.low.x), shortest_text(box.high.x),
          shortest_text(box.low.y), shortest_text(box.high.y)),
      {file});
}

std::vector<LevelPart> trace(RasterRows& rows, const Window& window, const Contour& contour) {
  LevelOutline outline(window.frame, contour.level, contour.below);
  std::vector<float> row(static_cast<std::size_t>(window.frame.columns));
  for (std::int64_t j = window.frame.rows - 1; j >= 0; --j) {
    rows.read(window.bottom + j, window.left, row);
    outline.add_row(row);
  }
  rows.finish();
  return outline.parts();
}

bool holds(const LevelPart& part, const Point& p) {
  std::vector<const PolygonRing*> rings;
  for (const PolygonRing& ring : part.rings) rings.push_back(&ring);
  return is_inside(rings, p);
}

/// The largest part, or each part with a seed, once.
std::vector<LevelPart> meant_parts(std::vector<LevelPart> parts, const std::vector<double>& seeds,
                                   const std::string& file) {
  if (seeds.empty()) parts.resize(1);
  std::vector<bool> meant(parts.size(), seeds.empty());
  for (std::size_t k = 0; k + 1 < seeds.size(); k += 2) {
    const Point seed{seeds[k], seeds[k + 1]};
    const auto found = std::ranges::find_if(parts, [&](const LevelPart& part) { return holds(part, seed); });
    if (found == parts.end())
      throw Keyed<InputError>(
          KeyText::of("{}: has no part of the domain at ({}, {}), which {} names; move the point into the water", file,
                      shortest_text(seed.x), shortest_text(seed.y), KeyText::key("input.contour-seeds")),
          {file});
    meant[static_cast<std::size_t>(found - parts.begin())] = true;
  }
  std::vector<LevelPart> found;
  for (std::size_t k = 0; k < parts.size(); ++k)
    if (meant[k]) found.push_back(std::move(parts[k]));
  return found;
}

/// Edges of the ring on the sides of the window, as lines of the open sea.
void add_open_sea(const PolygonRing& ring, const Box& sides, GeoFeatures& features) {
  const std::vector<const PolygonRing*> rings{&ring};
  for_each_edge(rings, [&](const Point& a, const Point& b) {
    if ((a.x == b.x && (a.x == sides.low.x || a.x == sides.high.x)) ||
        (a.y == b.y && (a.y == sides.low.y || a.y == sides.high.y)))
      features.lines.push_back({{a, b}, kGeoOpen});
  });
}

}  // namespace

Contour contour_of(const Request::Input& input) {
  const std::string& text = input.contour;
  const std::size_t sign = text.find_first_of("=<>");
  double level = 0;
  if (sign == std::string::npos || !read_number(text.substr(sign + 1), false, level))
    throw KeyError("input.contour", "is '" + text + "'",
                   "write the name of a raster and a level: depth=0, elevation<0");
  Contour contour{text.substr(0, sign), level, text[sign] == '<'};
  if (!input.rasters.contains(contour.raster))
    throw KeyError("input.contour", "names '" + contour.raster + "', but no raster has this name",
                   "name its file in {input.rasters}");
  const std::vector<double>& box = input.contour_box;
  if (!box.empty() && !(box.size() == 4 && box[0] < box[2] && box[1] < box[3]))
    throw KeyError("input.contour-box", "is no box", "write four numbers: west, south, east, north");
  if (input.contour_seeds.size() % 2 != 0)
    throw KeyError("input.contour-seeds", "has a point with one number", "write two for each: X,Y,X,Y");
  return contour;
}

std::string contour_files(const Request::Input& input) {
  return words_of_files(input.rasters.at(contour_of(input).raster));
}

InputFile contour_input(const Request::Input& input) {
  const Contour contour = contour_of(input);
  const std::string file = contour_files(input);
  const std::unique_ptr<RasterRows> rows = open_mosaic(files_in(input.rasters.at(contour.raster)));
  const Window window = window_of(rows->frame(), input.contour_box);
  refuse_small(window, rows->frame(), input, file);
  std::vector<LevelPart> parts = trace(*rows, window, contour);
  if (parts.empty())
    throw Keyed<InputError>(KeyText::of("{}: is nowhere {} {}, which {} asks for; give another level, or a raster that "
                                        "counts the other way",
                                        file, contour.below ? "below" : "above", shortest_text(contour.level),
                                        KeyText::key("input.contour")),
                            {file});
  const Box sides = box_of(window.frame);
  GeoFeatures features;
  for (LevelPart& part : meant_parts(std::move(parts), input.contour_seeds, file)) {
    for (const PolygonRing& ring : part.rings) add_open_sea(ring, sides, features);
    features.polygons.push_back({features.polygons.size() + 1, std::move(part.rings), std::nullopt, std::nullopt});
  }
  DomainSystem system = rows->domain_system();
  if (system.from_raster) for_each_point(features, [&](Point& p) { p = system.from_raster(p); });
  features.in_degrees = system.in_degrees;
  features.projection = system.projection;
  if (!system.in_degrees) features.system = kInMeters;
  return input_of(file, std::move(features), input.projection);
}

}  // namespace driftmesh::job
