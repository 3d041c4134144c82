#include "verify/size_check.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "geometry/predicates.hpp"

namespace driftmesh {
namespace {

constexpr double kRounding = 1e-8;  // relative
constexpr double kFewest = 16;      // points of a triangle
constexpr double kPerSquare = 4;    // points per square of the spacing

/// Point k of an even spread over a triangle: an additive recurrence in the unit square (Roberts, "The unreasonable
/// effectiveness of quasirandom sequences", 2018) whose upper half is folded down.
Point spread(const std::array<Point, 3>& t, std::uint64_t k) {
  constexpr double kPlastic = 1.32471795724474602596;
  const auto part = [k](double step) {
    const double x = 0.5 + static_cast<double>(k) * step;
    return x - std::floor(x);
  };
  double u = part(1 / kPlastic), v = part(1 / (kPlastic * kPlastic));
  if (u + v > 1) {
    u = 1 - u;
    v = 1 - v;
  }
  const double w = 1 - u - v;
  return {w * t[0].x + u * t[1].x + v * t[2].x, w * t[0].y + u * t[1].y + v * t[2].y};
}

bool holds(const std::array<Point, 3>& t, const Point& p) {
  return orient2d(t[0], t[1], p) >= 0 && orient2d(t[1], t[2], p) >= 0 && orient2d(t[2], t[0], p) >= 0;
}

}  // namespace

SizeCheck::SizeCheck(const SizeField& field, double spacing, double most_area, double at_corners)
    : field_(field), spacing_(spacing), most_area_(most_area), at_corners_(at_corners) {
  std::vector<Box> boxes;
  field.visit_marks([&](const Point& p) {
    marks_.push_back({p, 0});
    boxes.push_back({p, p});
  });
  mark_tree_ = BoxTree(boxes);
  for (Miss& mark : marks_) mark.length = field.edge_length(mark.at);
}

double SizeCheck::at_corners(const Triangle& triangle) const {
  const auto& [a, b, c] = triangle;
  double h = field_.edge_length({(a.x + b.x + c.x) / 3, (a.y + b.y + c.y) / 3});
  for (const Point& p : {a, b, c}) h = std::min(h, field_.edge_length(p));
  return h / at_corners_;
}

std::optional<SizeCheck::Miss> SizeCheck::find_miss(const Triangle& t, double area) const {
  const double edge = std::sqrt(area * (4 / std::numbers::sqrt3)) * (1 - kRounding);
  if (const auto miss = at_marks(t, at_corners_ * edge)) return miss;
  return at_samples(t, area, kTolerated * edge);
}

std::optional<SizeCheck::Miss> SizeCheck::at_marks(const Triangle& t, double edge) const {
  std::optional<Miss> found;
  const Box box = Box::of(t);
  mark_tree_.search([&](const Box& around) { return !found && around.overlaps(box); },
                    [&](std::int32_t i) {
                      const Miss& mark = marks_[i];
                      if (!found && mark.length < edge && holds(t, mark.at)) found = mark;
                    });
  return found;
}

std::optional<SizeCheck::Miss> SizeCheck::at_samples(const Triangle& t, double area, double edge) const {
  const double dense = spacing_ > 0 ? kPerSquare * std::min(area, most_area_) / (spacing_ * spacing_) : 0;
  const auto count = static_cast<std::uint64_t>(std::max(kFewest, dense));
  for (std::uint64_t k = 1; k <= count; ++k) {
    const Point p = spread(t, k);
    if (const double length = field_.edge_length(p); length < edge) return Miss{p, length};
  }
  return std::nullopt;
}

}  // namespace driftmesh
