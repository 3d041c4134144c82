#include "sizing/graded_field.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "geometry/midpoint.hpp"
#include "geometry/triangle_geometry.hpp"

namespace driftmesh {
namespace {

constexpr double kAccurate = 0.95;  // of the length
constexpr int kMostCells = 50'000;  // looked at for one point
constexpr int kMostHalvings = 30;   // of the box
constexpr int kMostParts = 6;       // halvings of a triangle

/// Of the expression over a box, as far as it is positive there.
double positive_bound(const ExpressionField& field, const Box& box) {
  const Interval range = field.range(box);
  return range.high > 0 ? std::max(range.low, 0.0) : std::numeric_limits<double>::infinity();
}

}  // namespace

struct GradedField::Query {
  Point at;
  double length;  // the least so far
  int cells = 0;
};

GradedField::GradedField(std::unique_ptr<const ExpressionField> field, double gradation, const Box& box)
    : field_(std::move(field)),
      gradation_(gradation),
      box_(box),
      search_([this](const Box& cell) { return positive_bound(*field_, cell); },
              std::numeric_limits<double>::infinity()),
      root_(LeastSearch::Cell::first_of_cover(box)) {}

double GradedField::edge_length(const Point& p) const {
  Query query{p, field_->edge_length(p)};
  for (std::int64_t j = root_.j; j <= root_.j + 1; ++j)
    for (std::int64_t i = root_.i; i <= root_.i + 1; ++i) descend(query, {i, j, root_.exponent});
  return query.length;
}

double GradedField::bound_from(const Point& p, const LeastSearch::Cell& cell) const {
  return search_.lower_bound(cell) + gradation_ * std::sqrt(cell.box().squared_distance(p));
}

/// The most promising quarters first.
void GradedField::descend(Query& query, const LeastSearch::Cell& cell) const {
  const Box box = cell.box();
  if (!box.overlaps(box_) || bound_from(query.at, cell) >= kAccurate * query.length) return;
  if (cell.exponent < root_.exponent - kMostHalvings || cell.is_smallest() || ++query.cells > kMostCells) return;
  if (const Point center = box.center(); box_.contains(center))
    if (const double here = field_->value(center); here > 0)
      query.length = std::min(query.length, here + gradation_ * std::sqrt(squared_distance(query.at, center)));
  const std::array<LeastSearch::Cell, 4> parts = cell.quarters();
  std::array<std::pair<double, LeastSearch::Cell>, 4> quarters;
  for (std::size_t k = 0; k < 4; ++k) quarters[k] = {bound_from(query.at, parts[k]), parts[k]};
  std::stable_sort(quarters.begin(), quarters.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  for (const auto& [bound, quarter] : quarters) descend(query, quarter);
}

namespace {

/// Whether `field`, which grows no faster than `gradation`, counts as less than `length` in a part of a triangle.
bool counts_in(const SizeField& field, double gradation, const CornerPoints& part, double length, int depth) {
  const Point middle = centroid(part);
  double farthest = 0;
  for (const Point& p : part) farthest = std::max(farthest, std::sqrt(squared_distance(p, middle)));
  if (depth == 0 && gradation * farthest <= (1 - kTolerated) * length) return false;  // it is `length` in the middle
  const double here = field.edge_length(middle);
  if (here < kCounts * length) return true;
  if (depth == kMostParts || here - gradation * farthest >= kTolerated * length) return false;
  const Point ab = midpoint(part[0], part[1]), bc = midpoint(part[1], part[2]), ca = midpoint(part[2], part[0]);
  for (const CornerPoints& quarter :
       {CornerPoints{part[0], ab, ca}, {ab, part[1], bc}, {ca, bc, part[2]}, {bc, ca, ab}})
    if (counts_in(field, gradation, quarter, length, depth + 1)) return true;
  return false;
}

}  // namespace

bool GradedField::falls_below(const std::array<Point, 3>& triangle, double length) const {
  return counts_in(*this, gradation_, triangle, length, 0);
}

}  // namespace driftmesh
