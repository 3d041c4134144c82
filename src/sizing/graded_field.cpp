#include "sizing/graded_field.hpp"

#include <algorithm>
#include <bit>
#include <climits>
#include <cmath>
#include <cstdint>
#include <utility>

#include "base/mix.hpp"
#include "geometry/midpoint.hpp"
#include "geometry/triangle_geometry.hpp"

namespace driftmesh {
namespace {

constexpr double kAccurate = 0.95;         // fraction of the length
constexpr int kMostCells = 50'000;         // looked at for one point
constexpr int kMostHalvings = 30;          // halvings of the box
constexpr int kMostParts = 6;              // halvings of a triangle
constexpr double kNarrow = 2;              // lengths change by less than so many times themselves across a narrow zone
constexpr int kFiner = 2;                  // sources are 2^-kFiner times as wide as their zone
constexpr std::size_t kMostSources = 256;  // a zone with more is not divided
constexpr std::size_t kMostZones = std::size_t{1} << 13;
constexpr std::size_t kMostKnown = std::size_t{1} << 15;
constexpr std::size_t kMostAnswers = std::size_t{1} << 12;

std::uint64_t hash_of(const Point& p) {
  return mix(mix(std::bit_cast<std::uint64_t>(p.x)) + std::bit_cast<std::uint64_t>(p.y));
}

double distance(const Point& p, const Point& q) {
  return std::sqrt(squared_distance(p, q));
}

/// From the nearest points of two boxes.
double gap(const Box& a, const Box& b) {
  const double dx = std::max({a.low.x - b.high.x, b.low.x - a.high.x, 0.0});
  const double dy = std::max({a.low.y - b.high.y, b.low.y - a.high.y, 0.0});
  return std::sqrt(dx * dx + dy * dy);
}

double farthest(const Box& box, const Point& p) {
  const double dx = std::max(box.high.x - p.x, p.x - box.low.x);
  const double dy = std::max(box.high.y - p.y, p.y - box.low.y);
  return std::sqrt(dx * dx + dy * dy);
}

}  // namespace

GradedField::GradedField(std::unique_ptr<const ExpressionField> field, double gradation, const Box& box)
    : field_(std::move(field)),
      gradation_(gradation),
      box_(box),
      root_(Cell::first_of_cover(box)),
      known_(kMostKnown, Source{{0, 0, INT_MIN}}),
      answers_(kMostAnswers) {
  for (std::int64_t j = root_.j; j <= root_.j + 1; ++j)
    for (std::int64_t i = root_.i; i <= root_.i + 1; ++i)
      if (const Cell cell{i, j, root_.exponent}; has_part(cell.box())) everywhere_.sources.push_back(source_at(cell));
}

std::size_t GradedField::CellHash::operator()(const Cell& cell) const {
  return mix(mix(static_cast<std::uint64_t>(cell.i) * kMixStep + static_cast<std::uint64_t>(cell.j)) +
             static_cast<std::uint64_t>(cell.exponent));
}

/// Kept in a table, because neighboring points and zones ask for the same ones.
GradedField::Source GradedField::source_at(const Cell& cell) const {
  Source& known = known_[CellHash{}(cell) % kMostKnown];
  if (known.cell == cell) return known;
  known = {cell, cell.box()};
  if (const Interval range = field_->range(known.box); range.high > 0) known.least = std::max(range.low, 0.0);
  return known;
}

/// Only where it is needed, since values take as long as bounds.
double GradedField::middle_of(const Source& source) const {
  Source& known = known_[CellHash{}(source.cell) % kMostKnown];
  if (known.cell == source.cell && known.middle != kNotAsked) return known.middle;
  double middle = kUnlimited;
  if (const Point center = source.box.center(); box_.contains(center))
    if (const double here = field_->value(center); here > 0) middle = here;
  if (known.cell == source.cell) known.middle = middle;
  return middle;
}

/// Not by a side alone, whose points are in the cells on the other side of it, too, where there are centers to look at.
bool GradedField::has_part(const Box& box) const {
  return box.low.x < box_.high.x && box.high.x > box_.low.x && box.low.y < box_.high.y && box.high.y > box_.low.y;
}

bool GradedField::is_deepest(const Cell& cell) const {
  return cell.exponent < root_.exponent - kMostHalvings || cell.is_smallest();
}

// ---- At a point ----

struct GradedField::Query {
  Point at;
  double length;  // the least so far
  int cells = 0;
};

/// Points are asked for more than once: as corners of triangles and of their parts.
double GradedField::edge_length(const Point& p) const {
  Answer& latest = answers_[hash_of(p) % kMostAnswers];
  if (latest.at != p || latest.length == kNotAsked) latest = {p, found_length(p)};
  return latest.length;
}

double GradedField::found_length(const Point& p) const {
  Query query{p, field_->edge_length(p)};
  const Zone& zone = box_.contains(p) ? zone_of(p) : everywhere_;
  query.length = std::min(query.length, zone.at_best + gradation_ * distance(p, zone.best));
  for (const Source& source : zone.sources) descend(query, source);
  return query.length;
}

double GradedField::bound_from(const Point& p, const Source& source) const {
  return source.least + gradation_ * std::sqrt(source.box.squared_distance(p));
}

void GradedField::take_center(Query& query, const Source& source) const {
  query.length = std::min(query.length, middle_of(source) + gradation_ * distance(query.at, source.box.center()));
}

/// The most promising quarters first; of equals, the first.
void GradedField::descend(Query& query, const Source& source) const {
  if (bound_from(query.at, source) >= kAccurate * query.length) return;
  if (is_deepest(source.cell) || ++query.cells > kMostCells) return;
  take_center(query, source);
  std::array<std::pair<double, Source>, 4> quarters;
  std::size_t count = 0;
  for (const Cell& cell : source.cell.quarters()) {
    const Source quarter = source_at(cell);
    if (!has_part(quarter.box)) continue;
    const double bound = bound_from(query.at, quarter);
    if (bound >= kAccurate * query.length) continue;
    std::size_t place = count++;
    for (; place > 0 && quarters[place - 1].first > bound; --place) quarters[place] = quarters[place - 1];
    quarters[place] = {bound, quarter};
  }
  for (std::size_t k = 0; k < count; ++k) descend(query, quarters[k].second);
}

// ---- Zones ----

/// The narrow one that a point is in. Points that are asked for one after the other are mostly in the same.
const GradedField::Zone& GradedField::zone_of(const Point& p) const {
  if (latest_ != nullptr && Cell::around(p, latest_->cell.exponent) == latest_->cell) return *latest_;
  if (zones_.size() >= kMostZones) zones_.clear();
  latest_ = &zone_at(Cell::around(p, root_.exponent), everywhere_);
  while (is_wide(*latest_)) latest_ = &zone_at(Cell::around(p, latest_->cell.exponent - 1), *latest_);
  return *latest_;
}

bool GradedField::is_wide(const Zone& zone) const {
  if (zone.sources.empty() || is_deepest(zone.cell)) return false;
  return zone.most == kUnlimited || gradation_ * zone.cell.width() > kNarrow * zone.most;
}

const GradedField::Zone& GradedField::zone_at(const Cell& cell, const Zone& around) const {
  const auto [found, is_new] = zones_.try_emplace(cell, Zone{cell, cell.box()});
  if (is_new) begin(found->second, around);
  return found->second;
}

/// A source is left out if no point of the zone has it to thank for a twentieth of its length.
void GradedField::begin(Zone& zone, const Zone& around) const {
  if (const double high = field_->range(zone.box).high; high > 0) zone.most = high;
  start_from(zone, around.best, around.at_best);
  for (const Source& source : around.sources) add(zone, source);
  std::erase_if(zone.sources, [&](const Source& source) { return bound_from(zone, source) >= kAccurate * zone.most; });
  const Point middle = zone.box.center();
  std::ranges::stable_sort(zone.sources, {}, [&](const Source& source) { return bound_from(middle, source); });
}

/// In parts that are narrower than the zone.
void GradedField::add(Zone& zone, const Source& source) const {
  if (bound_from(zone, source) >= kAccurate * zone.most) return;
  start_from(zone, source.box.center(), middle_of(source));
  if (source.cell.exponent <= zone.cell.exponent - kFiner || is_deepest(source.cell) ||
      zone.sources.size() >= kMostSources) {
    zone.sources.push_back(source);
    return;
  }
  for (const Cell& quarter : source.cell.quarters())
    if (has_part(quarter.box())) add(zone, source_at(quarter));
}

void GradedField::start_from(Zone& zone, const Point& at, double length) const {
  const double most = length + gradation_ * farthest(zone.box, at);
  zone.most = std::min(zone.most, most);
  if (most >= zone.at_best + gradation_ * farthest(zone.box, zone.best)) return;
  zone.best = at;
  zone.at_best = length;
}

double GradedField::bound_from(const Zone& zone, const Source& source) const {
  return source.least + gradation_ * gap(zone.box, source.box);
}

// ---- In a triangle ----

namespace {

/// How far a point of a triangle can be from the nearest corner: with an obtuse angle, on the side opposite to it,
/// where the corner there is no nearer than the others.
double covering_radius(const CornerPoints& t) {
  std::array<double, 3> opposite{squared_distance(t[1], t[2]), squared_distance(t[2], t[0]),
                                 squared_distance(t[0], t[1])};
  std::ranges::sort(opposite);
  const auto& [a, b, c] = opposite;  // squared
  const double twice_area = 2 * std::fabs(signed_area(t[0], t[1], t[2]));
  if (c < a + b) return std::sqrt(a * b * c) / (2 * twice_area);
  // b / (2 cos of the angle between b and c), where cos = (b^2 + c^2 - a^2) / (2 b c); that for a is less.
  return b * std::sqrt(c) / (b + c - a);
}

/// The same from the nearest of the corners and the centroid, at most.
double covering_radius_with_centroid(const CornerPoints& t) {
  const Point middle = centroid(t);
  return std::max({covering_radius({t[0], t[1], middle}), covering_radius({t[1], t[2], middle}),
                   covering_radius({t[2], t[0], middle})});
}

}  // namespace

double GradedField::least_between(const std::array<Point, 3>& triangle, double at_corners) const {
  return kAccurate * at_corners - gradation_ * covering_radius(triangle);
}

namespace {

/// A point of a triangle, and a length that the field does not fall below there.
struct Anchor {
  Point at;
  double length;
};

double farthest(const CornerPoints& part, const Point& p) {
  return std::sqrt(
      std::max({squared_distance(part[0], p), squared_distance(part[1], p), squared_distance(part[2], p)}));
}

/// Whether a field that grows no faster than `gradation` counts as less than `length` in a part of a triangle, at the
/// corners of which it does not.
class CountingParts {
 public:
  CountingParts(const SizeField& field, double gradation, double length)
      : field_(field), gradation_(gradation), length_(length) {}

  [[nodiscard]] bool counts_in(const CornerPoints& part, const Anchor& known, int depth) const {
    if (suffices(part, known)) return false;
    const Point center = centroid(part);
    const Anchor middle{center, depth == 0 ? known.length : field_.edge_length(center)};
    if (middle.length < kCounts * length_) return true;
    if (depth == kMostParts || suffices(part, middle)) return false;
    const Point ab = midpoint(part[0], part[1]), bc = midpoint(part[1], part[2]), ca = midpoint(part[2], part[0]);
    const auto at_corner = [&](const Point& corner) { return depth == 0 ? Anchor{corner, length_} : middle; };
    return counts_in({part[0], ab, ca}, at_corner(part[0]), depth + 1) ||
           counts_in({ab, part[1], bc}, at_corner(part[1]), depth + 1) ||
           counts_in({ca, bc, part[2]}, at_corner(part[2]), depth + 1) || counts_in({bc, ca, ab}, middle, depth + 1);
  }

 private:
  [[nodiscard]] bool suffices(const CornerPoints& part, const Anchor& known) const {
    return known.length - gradation_ * farthest(part, known.at) >= kTolerated * length_;
  }

  const SizeField& field_;
  double gradation_, length_;
};

}  // namespace

/// It is `length` at the corners and in the middle, from where it can fall by so much only in long triangles.
bool GradedField::falls_below(const std::array<Point, 3>& triangle, double length) const {
  if (gradation_ * covering_radius_with_centroid(triangle) <= (1 - kTolerated) * length) return false;
  return CountingParts(*this, gradation_, length).counts_in(triangle, {centroid(triangle), length}, 0);
}

}  // namespace driftmesh
