#include "sizing/grown_function.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "geometry/triangle_geometry.hpp"

namespace driftmesh {
namespace {

constexpr double kFine = 0.5;  // squares are divided until they are so wide, relative to that around the questions
constexpr double kHardlyMore = 1 + 0x1p-40;  // for rounding
constexpr double kUnlimited = std::numeric_limits<double>::infinity();

double distance(const Point& p, const Point& q) {
  return std::sqrt(squared_distance(p, q));
}

/// From the nearest points of two boxes.
double gap(const Box& a, const Box& b) {
  const double dx = std::max({a.low.x - b.high.x, b.low.x - a.high.x, 0.0});
  const double dy = std::max({a.low.y - b.high.y, b.low.y - a.high.y, 0.0});
  return std::sqrt(dx * dx + dy * dy);
}

double width(const Box& box) {
  return box.high.x - box.low.x;
}

}  // namespace

GrownFunction::GrownFunction(std::shared_ptr<const SizeField> field, std::shared_ptr<const PlaneFunction> function,
                             double gradation, const Box& domain, const Accuracy& accuracy, double finest)
    : own_(function),
      steep_(std::make_shared<const SizeTree>(std::move(field), std::move(function), domain, finest,
                                              SizeTree::Rules{.narrow = accuracy.narrow, .steepest = gradation})),
      gradation_(gradation),
      search_(accuracy.search),
      domain_(domain),
      squares_{steep_->root().spot} {}

GrownFunction::GrownFunction(const GrownFunction& other, std::shared_ptr<const PlaneFunction> own)
    : own_(std::move(own)),
      steep_(other.steep_),
      gradation_(other.gradation_),
      search_(other.search_),
      domain_(other.domain_) {}

Box GrownFunction::part_in_domain(const Square& square) const {
  return {{std::max(square.box.low.x, domain_.low.x), std::max(square.box.low.y, domain_.low.y)},
          {std::min(square.box.high.x, domain_.high.x), std::min(square.box.high.y, domain_.high.y)}};
}

bool GrownFunction::matters(const Square& square) const {
  return (square.is_divided || square.is_steep) && square.box.overlaps(domain_);
}

// ---- At a point ----

double GrownFunction::at(const Point& p) const {
  double length = own_->at(p);
  if (!(length > 0)) return length;
  Least least{std::min(length, most_from(start_, p) * kHardlyMore), {}};
  for (const Spot& spot : squares_) descend(p, steep_->square_at(spot), least);
  return least.length;
}

/// The most promising quarters first.
void GrownFunction::descend(const Point& p, const Square& square, Least& least) const {
  if (!matters(square)) return;
  const Box part = part_in_domain(square);
  const double bound = square.least + gradation_ * std::sqrt(part.squared_distance(p));
  if (bound >= search_ * least.length) return;
  if (!square.is_divided) {
    least = {bound,
             {{std::clamp(p.x, part.low.x, part.high.x), std::clamp(p.y, part.low.y, part.high.y)}, square.least}};
    return;
  }
  const SizeTree::Steep quarters = steep_->steep_quarters(square);
  std::array<std::pair<double, const Square*>, 4> order;
  std::size_t count = 0;
  for (const Square& quarter : quarters) {
    const double here = quarter.least + gradation_ * std::sqrt(quarter.box.squared_distance(p));
    if (here >= search_ * least.length) continue;
    std::size_t place = count++;
    for (; place > 0 && order[place - 1].first > here; --place) order[place] = order[place - 1];
    order[place] = {here, &quarter};
  }
  for (std::size_t k = 0; k < count; ++k) descend(p, *order[k].second, least);
}

// ---- Over boxes ----

double GrownFunction::most_from(const Start& start, const Point& p) const {
  return start.length > 0 ? start.length + gradation_ * distance(start.at, p) : kUnlimited;
}

std::shared_ptr<const PlaneFunction> GrownFunction::within(const Box& box) const {
  auto own_within = own_->within(box);
  if (own_within == nullptr) own_within = own_;
  const std::shared_ptr<GrownFunction> found(new GrownFunction(*this, std::move(own_within)));
  const Point center = box.center();
  Least least{most_from(start_, center), start_};
  for (const Spot& spot : squares_) descend(center, steep_->square_at(spot), least);
  found->start_ = least.from;
  const Interval own = found->own_->over(box).value;
  const double most = own.undefined || !(own.high > 0) ? kUnlimited : own.high;
  const std::array<Point, 4> corners = NearestInSquare::corners_of(box);
  std::array<double, 4> rival;
  rival.fill(most);
  if (least.length < most)
    for (std::size_t k = 0; k < 4; ++k) rival[k] = most_from(found->start_, corners[k]) * kHardlyMore;
  const NearestInSquare near(box, gradation_, rival);
  // Memory that the next call takes over, so that squares are counted before they get their own.
  thread_local std::vector<Spot> room;
  std::vector<Spot> kept = std::exchange(room, {});
  kept.clear();
  for (const Spot& spot : squares_) keep(steep_->square_at(spot), near, kFine * width(box), kept);
  found->squares_.assign(kept.begin(), kept.end());
  room = std::move(kept);
  return found;
}

/// Of a square, the parts that may be nearest, no wider than `fine` where they are divided.
void GrownFunction::keep(const Square& square, const NearestInSquare& near, double fine,
                         std::vector<Spot>& kept) const {
  if (!matters(square) || !near.needs(square.least, part_in_domain(square))) return;
  if (square.is_divided && width(square.box) > fine)
    for (const Square& quarter : steep_->steep_quarters(square)) keep(quarter, near, fine, kept);
  else
    kept.push_back(square.spot);
}

Variation GrownFunction::over(const Box& box) const {
  Variation found = own_->over(box);
  Interval& value = found.value;
  double least = kUnlimited, most = kUnlimited;  // from the squares
  for (const Point& corner : NearestInSquare::corners_of(box)) {
    const double here = most_from(start_, corner);
    most = most == kUnlimited ? here : std::max(most, here);
  }
  const double radius = half_diagonal(box);
  DirectionRange range;
  for (const Spot& spot : squares_) {
    const Square square = steep_->square_at(spot);
    const Box part = part_in_domain(square);
    least = std::min(least, square.least + gradation_ * gap(part, box));
    const Point center = box.center();
    const Point from = square.is_divided ? part.center()
                                         : Point{std::clamp(center.x, part.low.x, part.high.x),
                                                 std::clamp(center.y, part.low.y, part.high.y)};
    const double away = distance(center, from);
    range.extend(directions_around({(center.x - from.x) / away, (center.y - from.y) / away},
                                   square.is_divided ? radius + half_diagonal(part) : radius, away));
  }
  if (least == kUnlimited || (!value.undefined && value.high <= least)) return found;
  const Interval limit{-gradation_, gradation_};
  const Interval in_x = intervals::multiply({gradation_, gradation_}, {range.low_x, range.high_x});
  const Interval in_y = intervals::multiply({gradation_, gradation_}, {range.low_y, range.high_y});
  const bool by_squares_alone = !value.undefined && value.low >= most;
  // Where the function counts by itself it is no steeper than the limit.
  const auto limited = [&](const Interval& slope, const Interval& by_squares) {
    if (by_squares_alone) return by_squares;
    const Interval own{std::clamp(slope.low, limit.low, limit.high), std::clamp(slope.high, limit.low, limit.high)};
    return intervals::hull(own, by_squares);
  };
  found.in_x = limited(found.in_x, in_x);
  found.in_y = limited(found.in_y, in_y);
  found.in_directions = limit;
  value = {std::min(value.low, least), std::min(value.high, most), value.undefined};
  return found;
}

}  // namespace driftmesh
