#include "sizing/expression_field.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <optional>
#include <set>
#include <vector>

#include "base/mix.hpp"
#include "driftmesh/error.hpp"
#include "sizing/expression_parser.hpp"
#include "sizing/expression_range.hpp"
#include "sizing/field_calls.hpp"
#include "sizing/least_search.hpp"
#include "sizing/segment_distance.hpp"

namespace driftmesh {

struct ExpressionField::Parser {
  std::string text;
  mu::Parser expression = expression_parser();
  double x = 0;
  double y = 0;
  PlaneVariables variables;
  std::vector<double> values;  // of these

  double value_at(const Point& p) {
    x = p.x;
    y = p.y;
    for (std::size_t k = 0; k < variables.size(); ++k) values[k] = variables[k].function->at(p);
    return expression.Eval();
  }
};

namespace {

std::string quoted(const std::string& text) {
  return '"' + text + '"';
}

[[noreturn]] void fail(const std::string& expression, const std::string& what, const std::string& next) {
  throw InputError({"size expression " + quoted(expression)}, what, next);
}

/// muParser's message without its period and without the position that many messages end in.
std::string bare_message(const mu::ParserError& error) {
  std::string message = error.GetMsg();
  for (const char* ending : {" found at position ", " at position ", " at expression position "})
    message.erase(std::min(message.find(ending), message.size()));
  message.erase(message.find_last_not_of(".! ") + 1);
  return message;
}

/// muParser counts positions from 0, and may point past the end; columns count from 1.
[[noreturn]] void fail(const mu::ParserError& error, const std::string& expression) {
  std::string what = bare_message(error);
  if (error.GetPos() >= 0)
    what = "column " + std::to_string(std::min<std::size_t>(error.GetPos(), expression.size()) + 1) + ": " + what;
  fail(expression, what,
       "it may use x, y, pi, e, numbers, + - * / ^, distance(), names of rasters and functions such as sqrt, min, exp");
}

std::string printed(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}

/// muParser would take "x = 1" as an assignment and continue with a different x.
void refuse_assignment(const std::string& expression) {
  for (std::size_t i = 0; i < expression.size(); ++i) {
    if (expression[i] != '=') continue;
    const bool comparison = i + 1 < expression.size() && expression[i + 1] == '=';
    const bool ends_comparison = i > 0 && std::string("<>!").find(expression[i - 1]) != std::string::npos;
    if (!comparison && !ends_comparison)
      fail(expression, "column " + std::to_string(i + 1) + ": a single \"=\"",
           "give the value alone, and compare with \"==\"");
    i += comparison ? 1 : 0;
  }
}

/// "1, 2, 5", only the first of them if there are very many.
std::string list_of(const std::set<std::int32_t>& markers) {
  constexpr std::size_t kMost = 20;
  std::string list;
  std::size_t listed = 0;
  for (const std::int32_t marker : markers) {
    if (listed == kMost) return list + " and " + std::to_string(markers.size() - kMost) + " more";
    list += (listed++ == 0 ? "" : ", ") + std::to_string(marker);
  }
  return list;
}

/// What the calls of distance in an expression measure.
void add_distances(const std::string& expression, const FieldCalls& calls, const Pslg* input,
                   PlaneVariables& variables) {
  if (calls.markers.empty()) return;
  std::set<std::int32_t> known;
  if (input != nullptr)
    for (const Pslg::Segment& s : input->segments) known.insert(s.marker);
  if (known.empty())
    fail(expression, "there are no segments that distance could measure to", "give an input that has segments");
  for (std::size_t k = 0; k < calls.markers.size(); ++k) {
    for (const std::int32_t marker : calls.markers[k])
      if (!known.contains(marker))
        fail(expression, "no segment has the marker " + std::to_string(marker),
             "the markers of segments are " + list_of(known));
    variables.push_back(
        {FieldCalls::distance_name(k), std::make_shared<const SegmentDistance>(*input, calls.markers[k])});
  }
}

void add_rasters(const std::string& expression, const FieldCalls& calls, const NamedRasters& rasters,
                 PlaneVariables& variables) {
  for (const NamedRaster& raster : rasters) variables.push_back({raster.name, values_of(raster.raster)});
  for (const std::string& name : calls.slopes) {
    const auto found = std::ranges::find(rasters, name, &NamedRaster::name);
    if (found == rasters.end())
      fail(expression, "slope asks for the raster '" + name + "', which is not given",
           "name its file: --raster " + name + "=FILE");
    variables.push_back({FieldCalls::slope_name(name), slope_of(found->raster)});
  }
}

constexpr double kRounding = 1e-9;  // relative

/// Whether values at some points are the same, and in the range at each, but for rounding: muParser multiplies
/// a * (x - b) out. They are, if both understand the same by the expression.
template <class Value>
bool agree(const ExpressionRange& range, const Value& value) {
  std::uint64_t state = 0;
  const auto random = [&state] { return static_cast<double>(mix(state += kMixStep) >> 11) * 0x1p-53; };
  for (int i = 0; i < 64; ++i) {
    const double scale = std::ldexp(1, i % 16 - 6);
    const Point p{(2 * random() - 1) * scale, (2 * random() - 1) * scale};
    const double found = value(p);
    const Interval expected = range.over({p, p});
    const double rounding = std::isfinite(found) ? kRounding * std::fabs(found) : 0;
    if (found < expected.low - rounding || found > expected.high + rounding) return false;
    const double own = range.at(p);
    const bool same = own == found || std::fabs(own - found) <= rounding || (std::isnan(own) && std::isnan(found));
    if (!same) return false;
  }
  return true;
}

}  // namespace

/// What is known about an expression that ExpressionRange understands. Its values then come from there, too: muParser
/// takes several times as long, most of it for calls of pow where a product does.
struct ExpressionField::Bounds {
  ExpressionRange range;
  LeastSearch search;
};

ExpressionField::ExpressionField(const std::string& expression, double shortest, double spacing, const Pslg* input,
                                 const NamedRasters& rasters)
    : parser_(std::make_unique<Parser>()), shortest_(shortest) {
  refuse_assignment(expression);
  const FieldCalls calls = take_field_calls(expression);
  parser_->text = expression;
  add_distances(expression, calls, input, parser_->variables);
  add_rasters(expression, calls, rasters, parser_->variables);
  parser_->values.resize(parser_->variables.size());
  mu::Parser& parser = parser_->expression;
  try {
    parser.DefineVar("x", &parser_->x);
    parser.DefineVar("y", &parser_->y);
    for (std::size_t k = 0; k < parser_->variables.size(); ++k)
      parser.DefineVar(parser_->variables[k].name, &parser_->values[k]);
    parser.SetExpr(calls.expression);
    int values = 0;
    parser.Eval(values);
    if (values != 1) fail(expression, "has " + std::to_string(values) + " values", "give a single length");
  } catch (const mu::ParserError& error) {
    fail(error, expression);
  }
  const std::optional<ExpressionRange> range = ExpressionRange::of(calls.expression, parser_->variables);
  if (!range || !agree(*range, [this](const Point& p) { return parser_->value_at(p); })) return;
  const auto bound = [=](const Box& box) { return std::max(range->over(box).low, shortest); };
  bounds_ = std::make_unique<Bounds>(Bounds{*range, LeastSearch(bound, spacing)});
}

ExpressionField::~ExpressionField() = default;

bool ExpressionField::has_bounds() const {
  return bounds_ != nullptr;
}

Interval ExpressionField::range(const Box& box) const {
  const Interval range = bounds_ ? bounds_->range.over(box) : intervals::kAll;
  return {std::max(range.low, shortest_), std::max(range.high, shortest_)};
}

double ExpressionField::least() const {
  return bounds_ ? std::max(bounds_->search.least(), 0.0) : shortest_;
}

double ExpressionField::least_near(const std::array<Point, 3>& triangle) const {
  return bounds_ ? std::max(bounds_->search.least_near(triangle), 0.0) : shortest_;
}

bool ExpressionField::falls_below(const std::array<Point, 3>& triangle, double length) const {
  return bounds_ && bounds_->search.is_below(*this, triangle, length);
}

double ExpressionField::value(const Point& p) const {
  if (bounds_) return std::max(bounds_->range.at(p), shortest_);
  try {
    return std::max(parser_->value_at(p), shortest_);  // NaN stays NaN
  } catch (const mu::ParserError& error) {
    fail(error, parser_->text);
  }
}

double ExpressionField::edge_length(const Point& p) const {
  const double length = value(p);
  if (length > 0) return length;
  fail(parser_->text, "is " + printed(parser_->value_at(p)) + " at x = " + printed(p.x) + ", y = " + printed(p.y),
       "it must be positive everywhere in the domain: use max(..., smallest length), or set a shortest edge");
}

}  // namespace driftmesh
