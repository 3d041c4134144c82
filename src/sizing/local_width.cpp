#include "sizing/local_width.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "driftmesh/error.hpp"
#include "geometry/box_tree.hpp"
#include "geometry/segment_geometry.hpp"
#include "geometry/triangle_geometry.hpp"
#include "sizing/nearest_in_square.hpp"

namespace driftmesh {
namespace {

constexpr std::size_t kFewestPieces = 4;  // fewer are not worth their memory
constexpr std::size_t kFewPieces = 48;

Point nearest_on(const AxisPiece& piece, const Point& p) {
  return nearest_point_on_segment(p, piece.a, piece.b);
}

double squared_to(const Point& p, const AxisPiece& piece) {
  return squared_distance(p, nearest_on(piece, p));
}

bool may_be_nearest(const NearestInSquare& square, const AxisPiece& piece) {
  return square.needs(nearest_on(piece, square.center()), piece.a, piece.b);
}

Interval twice_sum(const Interval& a, const Interval& b) {
  return intervals::multiply({2, 2}, intervals::add(a, b));
}

}  // namespace

struct LocalWidth::Axis {
  explicit Axis(std::vector<AxisPiece> found) : pieces(std::move(found)) {
    std::vector<Box> boxes;
    Box all;
    for (const AxisPiece& piece : pieces) {
      boxes.push_back(Box::around(piece.a, piece.b));
      all.extend(boxes.back());
      least = std::min(least, piece.radius);
    }
    tree = BoxTree(boxes);
    extent = 2 * half_diagonal(all);
    margin = margin_in(all);
  }
  std::vector<AxisPiece> pieces;
  BoxTree tree;
  double least = std::numeric_limits<double>::infinity();  // radius
  double extent = 0, margin = 0;
};

LocalWidth::LocalWidth(OutlineSegments outline) {
  sort_segments(outline);
  if (outline.empty()) throw Error("no outline to measure widths of");
  to_outline_ = std::make_shared<const SegmentDistance>(outline);
  axis_ = std::make_shared<const Axis>(medial_axis(outline));
  if (axis_->pieces.empty()) throw Error("the outline encloses nothing that has a width");
}

const AxisPiece& LocalWidth::nearest(const Point& p) const {
  if (few_.empty()) {
    // Not less than that of the box, so that no rounding error makes the least depend on the order of the search.
    const auto distance = [&](std::int32_t item) {
      const AxisPiece& piece = axis_->pieces[item];
      return std::max(squared_to(p, piece), Box::around(piece.a, piece.b).squared_distance(p));
    };
    return axis_->pieces[axis_->tree.nearest(p, distance)];
  }
  return *std::ranges::min_element(few_, {}, [&](const AxisPiece& piece) { return squared_to(p, piece); });
}

double LocalWidth::to_axis(const Point& p) const {
  return std::sqrt(squared_to(p, nearest(p)));
}

double LocalWidth::at(const Point& p) const {
  return 2 * (to_outline_->at(p) + to_axis(p));
}

Variation LocalWidth::over(const Box& box) const {
  constexpr Interval kSteepest{-4, 4};
  const double radius = half_diagonal(box);
  if (!std::isfinite(radius)) return {{2 * axis_->least, intervals::kAll.high}, kSteepest, kSteepest, kSteepest};
  const Variation outline = to_outline_->over(box);
  const Point center = box.center();
  const double middle = to_axis(center), rounding = 0x1p-48 * (middle + radius + axis_->extent);
  double least = axis_->least;
  DirectionRange range{-1, 1, -1, 1};
  if (!few_.empty()) {
    least = std::numeric_limits<double>::infinity();
    range = {};
    for (const AxisPiece& piece : few_) {
      const Point from = nearest_on(piece, center);
      const double away = std::sqrt(squared_distance(center, from));
      if (away > middle + 2 * radius + rounding) continue;
      least = std::min(least, piece.radius);
      range.extend(directions_around({(center.x - from.x) / away, (center.y - from.y) / away}, radius, away));
    }
  }
  const Interval axis{std::max(middle - radius - rounding, 0.0), middle + radius + rounding};
  Interval value = twice_sum(outline.value, axis);
  value.low = std::max(value.low, 2 * least);
  return {value, twice_sum(outline.in_x, {range.low_x, range.high_x}),
          twice_sum(outline.in_y, {range.low_y, range.high_y}), kSteepest};
}

std::shared_ptr<const PlaneFunction> LocalWidth::within(const Box& box) const {
  auto outline = to_outline_->within(box);
  std::vector<AxisPiece> found;
  bool is_narrowed = false;
  if (few_.empty() || few_.size() > kFewestPieces) {
    const AxisPiece& rival = nearest(box.center());
    const auto square = NearestInSquare::against(
        box, [&](const Point& p) { return std::sqrt(squared_to(p, rival)); }, axis_->margin);
    const auto visit = [&](const AxisPiece& piece) {
      if (found.size() <= kFewPieces && may_be_nearest(square, piece)) found.push_back(piece);
    };
    if (few_.empty())
      axis_->tree.search([&](const Box& around) { return found.size() <= kFewPieces && square.needs(0, around); },
                         [&](std::int32_t item) { visit(axis_->pieces[item]); });
    else
      std::ranges::for_each(few_, visit);
    is_narrowed = found.size() <= kFewPieces && (few_.empty() || found.size() < few_.size());
  }
  if (outline == nullptr && !is_narrowed) return nullptr;
  auto narrowed = std::make_shared<LocalWidth>(*this);
  if (outline != nullptr) narrowed->to_outline_ = std::move(outline);
  if (is_narrowed) narrowed->few_ = std::move(found);
  return narrowed;
}

}  // namespace driftmesh
