#include "sizing/expression_field.hpp"

#include <algorithm>
#include <cstdio>

#include "driftmesh/error.hpp"

namespace driftmesh {
namespace {

std::string printed(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}

}  // namespace

ExpressionField::ExpressionField(const std::string& expression, double shortest, double spacing, const Pslg* input,
                                 const NamedRasters& rasters)
    : text_(expression),
      expression_(expression, input, rasters),
      shortest_(shortest),
      search_([own = expression_, shortest](const Box& box) { return std::max(own.over(box).low, shortest); },
              spacing) {}

Interval ExpressionField::range(const Box& box) const {
  const Interval range = expression_.over(box);
  return {std::max(range.low, shortest_), std::max(range.high, shortest_)};
}

double ExpressionField::least() const {
  return std::max(search_.least(), 0.0);
}

double ExpressionField::least_near(const std::array<Point, 3>& triangle) const {
  return std::max(search_.least_near(triangle), 0.0);
}

bool ExpressionField::falls_below(const std::array<Point, 3>& triangle, double length) const {
  return search_.is_below(*this, triangle, length);
}

double ExpressionField::value(const Point& p) const {
  return std::max(expression_.at(p), shortest_);  // NaN stays NaN
}

double ExpressionField::edge_length(const Point& p) const {
  const double length = value(p);
  if (length > 0) return length;
  throw InputError(
      place_of_expression(text_),
      "is " + printed(expression_.at(p)) + " at x = " + printed(p.x) + ", y = " + printed(p.y),
      "it must be positive everywhere in the domain: use max(..., smallest length), or set a shortest edge");
}

}  // namespace driftmesh
