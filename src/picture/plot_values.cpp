#include "picture/plot_values.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include "geometry/triangle_geometry.hpp"

namespace driftmesh {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;
constexpr double kBestAngle = 60;

struct Corners {
  Corners(const Mesh& mesh, std::size_t t)
      : a(mesh.points[mesh.triangles[t][0]]),
        b(mesh.points[mesh.triangles[t][1]]),
        c(mesh.points[mesh.triangles[t][2]]) {}
  const Point& a;
  const Point& b;
  const Point& c;
};

// Smallest and largest angle in degrees: they lie opposite the shortest and the longest edge.
std::array<double, 2> extreme_angles(const Corners& t) {
  std::array<double, 3> square = {squared_distance(t.b, t.c), squared_distance(t.c, t.a), squared_distance(t.a, t.b)};
  std::sort(square.begin(), square.end());
  const double four_areas = 4 * std::fabs(signed_area(t.a, t.b, t.c));
  return {kDegrees * std::atan2(four_areas, square[1] + square[2] - square[0]),
          kDegrees * std::atan2(four_areas, square[0] + square[1] - square[2])};
}

/// Of the triangles in view.
std::vector<float> seen_of(const Mesh& mesh, const Box& shown, const std::vector<float>& values) {
  std::vector<float> seen;
  for (std::size_t t = 0; t < values.size(); ++t)
    if (is_shown(mesh, t, shown)) seen.push_back(values[t]);
  return seen;
}

std::function<Rgb(double)> colors_between(double low, double high) {
  return [low, high](double value) { return viridis((value - low) / (high - low)); };
}

PlotValues angle_values(const Mesh& mesh, const Box& shown) {
  PlotValues result;
  result.of_triangle.reserve(mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    result.of_triangle.push_back(static_cast<float>(extreme_angles({mesh, t})[0]));
  result.color_of = colors_between(0, kBestAngle);
  result.bar.high = kBestAngle;
  result.bar.title = "Smallest angle";
  result.bar.notes = {"degrees"};
  result.bar.ticks = linear_ticks(0, kBestAngle, 6);
  result.bar.histogram = histogram_of(seen_of(mesh, shown, result.of_triangle), 0, kBestAngle);
  return result;
}

// log10 of the smallest and largest area, without the outermost thousandth on both sides: a single sliver must not
// stretch the scale.
std::array<double, 2> area_range(std::vector<float> seen, double narrowest) {
  if (seen.empty()) return {0, 1};
  const auto quantile = [&seen](double share) {
    const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(seen.size() - 1));
    std::nth_element(seen.begin(), seen.begin() + at, seen.end());
    return double{seen[at]};
  };
  const double low = quantile(0.001);
  const double high = quantile(0.999);
  const double missing = std::max(narrowest - (high - low), 0.0);
  return {low - missing / 2, high + missing / 2};
}

PlotValues area_values(const Mesh& mesh, const Box& shown, bool dense) {
  PlotValues result;
  result.of_triangle.reserve(mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Corners corners(mesh, t);
    const double area = std::fabs(signed_area(corners.a, corners.b, corners.c));
    result.of_triangle.push_back(static_cast<float>(std::log10(std::max(area, 1e-300))));
  }
  // In a fine mesh one wants to see where it is finer, and not how areas vary among neighbors.
  const std::vector<float> seen = seen_of(mesh, shown, result.of_triangle);
  const auto [low, high] = area_range(seen, dense ? 1 : 0.2);
  result.color_of = colors_between(low, high);
  result.bar = logarithmic_bar("Area", low, high);
  result.bar.histogram = histogram_of(seen, low, high);
  return result;
}

/// Classes of values without an order; a single class 0 if there are no values.
template <class Value>
PlotValues class_values(const Mesh& mesh, const std::vector<Value>& of_triangle, const char* title, bool counts) {
  PlotValues result;
  result.title = counts ? std::string(title) + " (triangles)" : title;
  const auto value = [&](std::size_t t) { return of_triangle.empty() ? Value{0} : of_triangle[t]; };
  std::map<Value, std::size_t> triangles_of;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) ++triangles_of[value(t)];
  std::map<Value, float> number;
  for (const auto& [name, count] : triangles_of) {
    const std::size_t index = number.size();
    number[name] = static_cast<float>(index);
    const std::string label = friendly_number(static_cast<double>(name), 6);
    result.swatches.push_back({category_color(index), counts ? label + "  (" + grouped_digits(count) + ")" : label});
  }
  result.of_triangle.reserve(mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) result.of_triangle.push_back(number[value(t)]);
  result.color_of = [](double index) { return category_color(static_cast<std::size_t>(index)); };
  return result;
}

}  // namespace

bool is_shown(const Mesh& mesh, std::size_t t, const Box& shown) {
  const Corners corners(mesh, t);
  const auto [low_x, high_x] = std::minmax({corners.a.x, corners.b.x, corners.c.x});
  const auto [low_y, high_y] = std::minmax({corners.a.y, corners.b.y, corners.c.y});
  return low_x <= shown.high.x && high_x >= shown.low.x && low_y <= shown.high.y && high_y >= shown.low.y;
}

PlotSummary summarize(const Mesh& mesh, const Box& shown) {
  PlotSummary summary;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Corners corners(mesh, t);
    const auto [smallest, largest] = extreme_angles(corners);
    summary.smallest_angle = std::min(summary.smallest_angle, smallest);
    summary.largest_angle = std::max(summary.largest_angle, largest);
    if (!is_shown(mesh, t, shown)) continue;
    ++summary.shown_triangles;
    summary.shown_area += std::fabs(signed_area(corners.a, corners.b, corners.c));
  }
  return summary;
}

PlotValues plot_values(const Mesh& mesh, PlotColor color, const Box& shown, bool counts, bool dense) {
  switch (color) {
    case PlotColor::kAngle:
      return angle_values(mesh, shown);
    case PlotColor::kArea:
      return area_values(mesh, shown, dense);
    case PlotColor::kRegion:
      return class_values(mesh, mesh.regions, "Region", counts);
    case PlotColor::kSubdomain:
      return class_values(mesh, mesh.subdomains, "Subdomain", counts);
    case PlotColor::kRank:
      return class_values(mesh, mesh.ranks, "Rank", counts);
    case PlotColor::kAutomatic:  // decided by now
    case PlotColor::kPlain:
      break;
  }
  PlotValues result;
  result.of_triangle.assign(mesh.triangles.size(), 0);
  result.color_of = [](double) { return kPlainFill; };
  return result;
}

}  // namespace driftmesh
