#include "verify/arrangement_sweep.hpp"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <tuple>

#include "base/formatted.hpp"
#include "driftmesh/id_vector.hpp"
#include "geometry/predicates.hpp"
#include "verify/words.hpp"

namespace driftmesh {
namespace {

bool lexicographically_less(const Point& a, const Point& b) {
  return std::tie(a.x, a.y) < std::tie(b.x, b.y);
}

bool in_range(const Point& p) {
  return in_coordinate_range(p.x) && in_coordinate_range(p.y);
}

/// The points in range.
std::vector<std::int32_t> sorted_order(std::span<const Point> points) {
  std::vector<std::int32_t> order;
  order.reserve(points.size());
  for (const std::int32_t i : first_ids<std::int32_t>(points.size()))
    if (in_range(points[i])) order.push_back(i);
  std::sort(order.begin(), order.end(),
            [&](std::int32_t a, std::int32_t b) { return lexicographically_less(points[a], points[b]); });
  return order;
}

template <class KeyOf>
void group_by(std::size_t keys, std::size_t items, const KeyOf& key_of, std::vector<std::int32_t>& first,
              std::vector<std::int32_t>& grouped) {
  first.assign(keys + 1, 0);
  for (std::size_t i = 0; i < items; ++i) ++first[key_of(i) + 1];
  std::partial_sum(first.begin(), first.end(), first.begin());
  grouped.resize(items);
  std::vector<std::int32_t> next(first.begin(), first.end() - 1);
  for (std::size_t i = 0; i < items; ++i) grouped[next[key_of(i)]++] = static_cast<std::int32_t>(i);
}

std::span<const std::int32_t> group(const std::vector<std::int32_t>& first, const std::vector<std::int32_t>& grouped,
                                    std::int32_t key) {
  return std::span(grouped).subspan(first[key], first[key + 1] - first[key]);
}

}  // namespace

ArrangementSweep::ArrangementSweep(std::span<const Point> points, std::span<const Arrangement::Link> links,
                                   std::span<const Point> queries)
    : points_(points),
      queries_(queries),
      status_(BelowOrder{this}),
      below_point_(points.size(), kNothing),
      below_query_(queries.size(), kNothing) {
  spans_.reserve(links.size());
  for (const auto& [a, b] : links) spans_.push_back(lexicographically_less(at(a), at(b)) ? Span{a, b} : Span{b, a});
  group_by(
      points.size(), spans_.size(), [&](std::size_t i) { return spans_[i].low; }, first_low_, by_low_);
  group_by(
      points.size(), spans_.size(), [&](std::size_t i) { return spans_[i].high; }, first_high_, by_high_);
  place_.resize(spans_.size());
}

void ArrangementSweep::run() {
  conflict_ = find_unfit();
  if (!conflict_) sweep();
}

/// What the sweep cannot pass.
std::optional<std::string> ArrangementSweep::find_unfit() const {
  for (const Point& p : points_)
    if (!in_range(p)) return "the point " + place_words(p) + " is outside the range of coordinates";
  for (const Span& s : spans_)
    if (at(s.low) == at(s.high)) return "a segment at " + place_words(at(s.low)) + " has no length";
  return std::nullopt;
}

void ArrangementSweep::sweep() {
  const std::vector<std::int32_t> point_order = sorted_order(points_), query_order = sorted_order(queries_);
  const auto twin = std::ranges::adjacent_find(point_order, {}, [&](std::int32_t i) { return at(i); });
  if (twin != point_order.end()) {
    conflict_ = "two points lie at " + place_words(at(*twin));
    return;
  }
  auto query = query_order.begin();
  for (const std::int32_t point : point_order) {
    const Point& p = at(point);
    for (; query != query_order.end(); ++query) {
      const Point& q = queries_[*query];
      if (lexicographically_less(p, q)) break;
      const bool has_links = !group(first_low_, by_low_, point).empty() || !group(first_high_, by_high_, point).empty();
      locate_query(*query, q == p && has_links);
    }
    visit_point(point);
    if (conflict_) return;
  }
}

double ArrangementSweep::side_of(std::int32_t link, const Point& p) const {
  return orient2d(at(span(link).low), at(span(link).high), p);
}

// Both are active, so the later of the two starts is a place where they can be compared.
bool ArrangementSweep::link_below_link(std::int32_t a, std::int32_t b) const {
  const Span &sa = span(a), &sb = span(b);
  if (sa.low == sb.low) return orient2d(at(sa.low), at(sa.high), at(sb.high)) > 0;
  if (lexicographically_less(at(sa.low), at(sb.low))) return side_of(a, at(sb.low)) > 0;
  return side_of(b, at(sa.low)) < 0;
}

bool ArrangementSweep::meet_wrongly(std::int32_t a, std::int32_t b) const {
  const Span &sa = span(a), &sb = span(b);
  if (sa.low == sb.low || sa.high == sb.high) return false;  // an overlap shows when the later one starts
  if (sa.high == sb.low || sb.high == sa.low) return false;
  const double a1 = side_of(a, at(sb.low)), a2 = side_of(a, at(sb.high));
  const double b1 = side_of(b, at(sa.low)), b2 = side_of(b, at(sa.high));
  if (a1 == 0 && a2 == 0)
    return !lexicographically_less(at(sa.high), at(sb.low)) && !lexicographically_less(at(sb.high), at(sa.low));
  const bool b_reaches_a = (a1 <= 0 && a2 >= 0) || (a1 >= 0 && a2 <= 0);
  const bool a_reaches_b = (b1 <= 0 && b2 >= 0) || (b1 >= 0 && b2 <= 0);
  return b_reaches_a && a_reaches_b;
}

void ArrangementSweep::locate_query(std::size_t query, bool on_point) {
  const Point& q = queries_[query];
  const auto above = status_.lower_bound(q);
  const bool on_link = above != status_.end() && side_of(*above, q) == 0;
  if (on_point || on_link)
    below_query_[query] = kOn;
  else if (above != status_.begin())
    below_query_[query] = *std::prev(above);
}

void ArrangementSweep::visit_point(std::int32_t point) {
  end_links(point);
  const auto above = status_.lower_bound(at(point));
  if (above != status_.end() && side_of(*above, at(point)) == 0) {
    const Point& p = at(point);
    const Point &a = at(span(*above).low), &b = at(span(*above).high);
    conflict_ = formatted("({:.17g}, {:.17g}) lies on the segment from ({:.17g}, {:.17g}) to ({:.17g}, {:.17g})", p.x,
                          p.y, a.x, a.y, b.x, b.y);
    return;
  }
  const std::int32_t below = above == status_.begin() ? kNothing : *std::prev(above);
  below_point_[point] = below;
  start_links(point);
  if (conflict_) return;
  const auto first = below == kNothing ? status_.begin() : std::next(place_[below]);
  if (first != status_.end()) check_neighbors(below, first);
  if (above != status_.end() && above != first) check_neighbors(*std::prev(above), above);
}

void ArrangementSweep::end_links(std::int32_t point) {
  for (const std::int32_t link : group(first_high_, by_high_, point)) status_.erase(place_[link]);
}

void ArrangementSweep::start_links(std::int32_t point) {
  for (const std::int32_t link : group(first_low_, by_low_, point)) {
    const auto [place, inserted] = status_.insert(link);
    if (!inserted) return report("overlap", link, *place);
    place_[link] = place;
  }
}

void ArrangementSweep::check_neighbors(std::int32_t below, Status::iterator upper) {
  if (below != kNothing && meet_wrongly(below, *upper)) report("cross or touch", below, *upper);
}

void ArrangementSweep::report(const char* what, std::int32_t link, std::int32_t other) {
  const Point &a = at(span(link).low), &b = at(span(link).high), &c = at(span(other).low), &d = at(span(other).high);
  conflict_ = formatted(
      "the segments from ({:.17g}, {:.17g}) to ({:.17g}, {:.17g}) and from ({:.17g}, {:.17g}) to ({:.17g}, {:.17g}) {}",
      a.x, a.y, b.x, b.y, c.x, c.y, d.x, d.y, what);
}

}  // namespace driftmesh
