#include "sizing/expression_field.hpp"

#include <algorithm>

#include "base/formatted.hpp"
#include "driftmesh/error.hpp"
#include "sizing/expression.hpp"
#include "sizing/limited_function.hpp"

namespace driftmesh {
namespace {

std::string printed(double value) {
  return formatted("{:.17g}", value);
}

}  // namespace

ExpressionField::ExpressionField(const std::string& expression, double shortest, double longest, const Pslg* input,
                                 const NamedRasters& rasters, const FindOutline& outline)
    : text_(expression), function_(std::make_shared<const Expression>(expression, input, rasters, outline)) {
  if (shortest > 0 || longest < std::numeric_limits<double>::infinity())
    function_ = limited(function_, shortest > 0 ? shortest : intervals::kAll.low, longest);
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
