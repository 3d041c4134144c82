#include "driftmesh/size_rule.hpp"

#include <algorithm>
#include <atomic>
#include <cctype>
#include <cmath>
#include <utility>

#include "base/formatted.hpp"
#include "driftmesh/error.hpp"
#include "driftmesh/size_on_mesh.hpp"
#include "job/value.hpp"
#include "raster/nearest_values.hpp"
#include "raster/raster.hpp"
#include "sizing/background_function.hpp"
#include "sizing/described_field.hpp"
#include "sizing/gradation.hpp"
#include "sizing/named_raster.hpp"
#include "sizing/segment_distance.hpp"

namespace driftmesh {

struct SizeRule::Parts {
  explicit Parts(SizingOptions asked, bool calls = false) : field(std::move(asked)), calls_back(calls) {}
  DescribedField field;
  bool calls_back;
  [[nodiscard]] const SizingOptions& asked() const { return field.asked(); }
  [[nodiscard]] bool is_limited() const {
    return asked().gradation.has_value() || asked().shortest > 0 || std::isfinite(asked().longest);
  }
};

namespace {

/// Known at points alone.
class CallerFunction final : public PlaneFunction {
 public:
  explicit CallerFunction(std::function<double(const Point&)> function) : function_(std::move(function)) {}
  [[nodiscard]] double at(const Point& p) const override { return function_(p); }
  [[nodiscard]] Variation over(const Box&) const override {
    constexpr Interval kAll = intervals::kAll;
    return {{kAll.low, kAll.high, true}, kAll, kAll, kAll};
  }

 private:
  std::function<double(const Point&)> function_;
};

/// A name that no other rule of this process has.
std::string new_name() {
  static std::atomic<std::uint64_t> made{0};
  return "rule_" + std::to_string(++made);
}

SizingOptions of_formula(std::string formula) {
  SizingOptions asked;
  asked.expression = std::move(formula);
  return asked;
}

SizingOptions of_named(NamedRaster named) {
  SizingOptions asked = of_formula(named.name);
  asked.rasters.push_back(std::move(named));
  return asked;
}

SizingOptions of_function(std::shared_ptr<const PlaneFunction> function) {
  return of_named({new_name(), nullptr, std::move(function)});
}

std::shared_ptr<const Raster> raster_of(const GridValues& grid) {
  const auto rows = grid.columns > 0 ? static_cast<std::int64_t>(grid.values.size()) / grid.columns : 0;
  if (grid.columns < 2 || rows < 2 || static_cast<std::size_t>(rows * grid.columns) != grid.values.size())
    throw Error("a raster has " + std::to_string(grid.values.size()) + " values in " + std::to_string(grid.columns) +
                " columns; give at least two full rows and columns");
  if (!(std::isfinite(grid.x0) && std::isfinite(grid.y0) && std::isfinite(grid.dx) && std::isfinite(grid.dy)) ||
      grid.dx == 0 || grid.dy == 0)
    throw Error("a raster has spacings or a place that are 0 or not finite");
  const bool flips_x = grid.dx < 0, flips_y = grid.dy < 0;
  const auto end = [](double first, double step, std::int64_t count) {
    return step < 0 ? first + step * static_cast<double>(count - 1) : first;
  };
  TiledGrid tiled(RasterFrame{.columns = grid.columns,
                              .rows = rows,
                              .first = {end(grid.x0, grid.dx, grid.columns), end(grid.y0, grid.dy, rows)},
                              .dx = std::fabs(grid.dx),
                              .dy = std::fabs(grid.dy)});
  if (std::ranges::none_of(grid.values, [](float v) { return std::isfinite(v); }))
    throw Error("a raster has no value that is a number");
  for (std::int64_t j = 0; j < rows; ++j)
    for (std::int64_t i = 0; i < grid.columns; ++i) {
      const float value = grid.values[static_cast<std::size_t>(j * grid.columns + i)];
      if (std::isinf(value)) throw Error("a raster has an infinite value; NaN is a gap");
      tiled.set(flips_x ? grid.columns - 1 - i : i, flips_y ? rows - 1 - j : j, value);
    }
  fill_from_nearest(tiled, std::fabs(grid.dx), std::fabs(grid.dy));
  return std::make_shared<const GridRaster>(std::move(tiled));
}

bool is_name_character(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

/// The formula with other text for a name.
std::string replaced(const std::string& formula, const std::string& name, const std::string& by) {
  std::string result;
  for (std::size_t i = 0; i < formula.size();) {
    std::size_t end = i;
    while (end < formula.size() && is_name_character(formula[end])) ++end;
    end = std::max(end, i + 1);
    const std::string word = formula.substr(i, end - i);
    result += word == name ? by : word;
    i = end;
  }
  return result;
}

std::shared_ptr<const BackgroundFunction> lengths_on(const Mesh& mesh, std::vector<double> lengths, double gradation) {
  if (lengths.size() != mesh.points.size())
    throw Error("size_on_mesh: there are " + std::to_string(lengths.size()) + " lengths for " +
                std::to_string(mesh.points.size()) + " points; give one for each");
  if (!(gradation >= 0)) throw Error(formatted("size_on_mesh: gradation is {}; it must be at least 0", gradation));
  auto background = std::make_shared<const BackgroundMesh>(mesh.points, mesh.triangles);
  if (gradation > 0) limit_gradation(mesh.points, mesh.triangles, gradation, lengths);
  return BackgroundFunction::of_points(std::move(background), std::move(lengths));
}

}  // namespace

std::shared_ptr<const SizeField> size_on_mesh(const Mesh& mesh, std::vector<double> lengths, double gradation) {
  SizingOptions asked;
  asked.lengths = lengths_on(mesh, std::move(lengths), gradation);
  return std::make_shared<const DescribedField>(std::move(asked));
}

SizeRule::SizeRule(double length) {
  if (std::isnan(length)) throw Error("a size rule is NaN");
  const std::string text = std::isinf(length) ? "(1/0)" : job::shortest_text(std::fabs(length));
  parts_ = std::make_shared<const Parts>(of_formula(length < 0 ? "(-" + text + ")" : text));
}

SizeRule SizeRule::expression(const std::string& formula, const Named& named) {
  std::string all = "(" + formula + ")";
  std::vector<SizeRule> rules;
  for (const auto& [name, rule] : named) {
    if (!can_name_raster(name))
      throw Error("a rule has the name '" + name +
                  "'; a name has letters, digits and underscores, and no other meaning in expressions");
    const std::string& text = rule.formula();
    all = replaced(all, name, std::ranges::all_of(text, is_name_character) ? text : "(" + text + ")");
    rules.push_back(rule);
  }
  return joined(named.empty() ? formula : all, rules);
}

SizeRule SizeRule::distance(const std::vector<std::int32_t>& markers) {
  std::string list;
  for (const std::int32_t marker : markers) list += (list.empty() ? "" : ", ") + std::to_string(marker);
  return joined("distance(" + list + ")", {});
}

SizeRule SizeRule::distance_to(const std::vector<std::array<Point, 2>>& segments) {
  if (segments.empty()) throw Error("there are no segments to measure the distance to");
  std::vector<SegmentDistance::Ends> ends;
  for (const auto& [a, b] : segments) {
    if (!(std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(b.x) && std::isfinite(b.y)))
      throw Error("a segment to measure the distance to has a coordinate that is not finite");
    ends.push_back({a, b});
  }
  return SizeRule(std::make_shared<const Parts>(of_function(std::make_shared<const SegmentDistance>(std::move(ends)))));
}

SizeRule SizeRule::width() {
  return joined("width()", {});
}

SizeRule SizeRule::curvature() {
  return joined("curvature()", {});
}

SizeRule SizeRule::raster(const GridValues& grid) {
  return SizeRule(std::make_shared<const Parts>(of_named({new_name(), raster_of(grid), nullptr})));
}

SizeRule SizeRule::slope(const GridValues& grid) {
  const SizeRule values = raster(grid);
  return joined("slope(" + values.formula() + ")", {values});
}

SizeRule SizeRule::on_mesh(const Mesh& mesh, std::vector<double> lengths, double gradation) {
  return SizeRule(std::make_shared<const Parts>(of_function(lengths_on(mesh, std::move(lengths), gradation))));
}

SizeRule SizeRule::function(std::function<double(const Point&)> function) {
  if (!function) throw Error("a size rule is an empty function");
  return SizeRule(
      std::make_shared<const Parts>(of_function(std::make_shared<const CallerFunction>(std::move(function))), true));
}

SizeRule SizeRule::limited(const Limits& limits) const {
  if (!(limits.gradation >= 0 && std::isfinite(limits.gradation)) || !(limits.shortest >= 0) || !(limits.longest > 0) ||
      limits.shortest > limits.longest)
    throw Error("limits of a size rule: gradation and the shortest length are at least 0, the longest is not less");
  SizingOptions asked = parts_->asked();
  if (limits.gradation > 0) asked.gradation = limits.gradation;
  asked.shortest = std::max(asked.shortest, limits.shortest);
  asked.longest = std::max(std::min(asked.longest, limits.longest), asked.shortest);
  return SizeRule(std::make_shared<const Parts>(std::move(asked), parts_->calls_back));
}

/// A formula of rules that are in it.
SizeRule SizeRule::joined(const std::string& formula, const std::vector<SizeRule>& rules) {
  SizingOptions asked = of_formula(formula);
  bool calls_back = false;
  for (const SizeRule& rule : rules) {
    if (rule.parts_->is_limited()) throw Error("a size rule with limits is a part of another; limit the whole instead");
    calls_back = calls_back || rule.parts_->calls_back;
    for (const NamedRaster& named : rule.parts_->asked().rasters)
      if (std::ranges::find(asked.rasters, named.name, &NamedRaster::name) == asked.rasters.end())
        asked.rasters.push_back(named);
  }
  return SizeRule(std::make_shared<const Parts>(std::move(asked), calls_back));
}

SizeRule SizeRule::call(const std::string& name, const SizeRule& a, const SizeRule& b) {
  return joined(name + "(" + a.formula() + ", " + b.formula() + ")", {a, b});
}

SizeRule operator+(const SizeRule& a, const SizeRule& b) {
  return SizeRule::joined("(" + a.formula() + ") + (" + b.formula() + ")", {a, b});
}

SizeRule operator-(const SizeRule& a, const SizeRule& b) {
  return SizeRule::joined("(" + a.formula() + ") - (" + b.formula() + ")", {a, b});
}

SizeRule operator*(const SizeRule& a, const SizeRule& b) {
  return SizeRule::joined("(" + a.formula() + ") * (" + b.formula() + ")", {a, b});
}

SizeRule operator/(const SizeRule& a, const SizeRule& b) {
  return SizeRule::joined("(" + a.formula() + ") / (" + b.formula() + ")", {a, b});
}

SizeRule min(const SizeRule& a, const SizeRule& b) {
  return SizeRule::call("min", a, b);
}

SizeRule max(const SizeRule& a, const SizeRule& b) {
  return SizeRule::call("max", a, b);
}

const std::string& SizeRule::formula() const {
  return parts_->asked().expression;
}

const SizeField& SizeRule::field() const {
  return parts_->field;
}

bool SizeRule::calls_back() const {
  return parts_->calls_back;
}

}  // namespace driftmesh
