#include "sizing/expression_field.hpp"

#include <algorithm>
#include <cstdio>
#include <utility>

#include "driftmesh/error.hpp"
#include "sizing/expression.hpp"

namespace driftmesh {
namespace {

std::string printed(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}

/// A function between two bounds. NaN stays NaN.
class Clamped final : public PlaneFunction {
 public:
  Clamped(std::shared_ptr<const PlaneFunction> function, double least, double most)
      : function_(std::move(function)), least_(least), most_(most) {}
  [[nodiscard]] double at(const Point& p) const override { return std::min(std::max(function_->at(p), least_), most_); }
  [[nodiscard]] Variation over(const Box& box) const override {
    Variation found = function_->over(box);
    const Interval before = found.value;
    found.value = intervals::smaller(intervals::larger(before, {least_, least_}), {most_, most_});
    const bool is_constant = !before.undefined && found.value.is_point();
    const bool changes = before.low < least_ || before.high > most_;
    for (Interval* slope : {&found.in_x, &found.in_y, &found.in_directions})
      if (is_constant)
        *slope = {0, 0};
      else if (changes)
        *slope = intervals::hull(*slope, {0, 0});
    return found;
  }
  [[nodiscard]] std::shared_ptr<const PlaneFunction> within(const Box& box) const override {
    auto narrowed = function_->within(box);
    return narrowed == nullptr ? nullptr : std::make_shared<const Clamped>(std::move(narrowed), least_, most_);
  }

 private:
  std::shared_ptr<const PlaneFunction> function_;
  double least_, most_;
};

}  // namespace

ExpressionField::ExpressionField(const std::string& expression, double shortest, double longest, const Pslg* input,
                                 const NamedRasters& rasters, const FindOutline& outline)
    : text_(expression), function_(std::make_shared<const Expression>(expression, input, rasters, outline)) {
  if (shortest > 0 || longest < std::numeric_limits<double>::infinity())
    function_ = std::make_shared<const Clamped>(function_, shortest > 0 ? shortest : intervals::kAll.low, longest);
}

double ExpressionField::least() const {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  return std::max(function_->over({{-kFar, -kFar}, {kFar, kFar}}).value.low, 0.0);
}

double ExpressionField::edge_length(const Point& p) const {
  const double length = function_->at(p);
  if (length > 0) return length;
  throw InputError(
      place_of_expression(text_), "is " + printed(length) + " at x = " + printed(p.x) + ", y = " + printed(p.y),
      "it must be positive everywhere in the domain: use max(..., smallest length), or set a shortest edge");
}

}  // namespace driftmesh
