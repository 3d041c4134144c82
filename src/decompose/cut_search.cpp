#include "decompose/cut_search.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/predicates.hpp"
#include "geometry/triangle_geometry.hpp"

namespace driftmesh {
namespace {

/// The length of a compact subdomain's border over the square root of its area, as measured for good decompositions.
constexpr double kPerimeter = 4.1;

/// The total border length of the `parts` subdomains that a piece will be cut into: compact ones, or slices if the
/// piece is long and thin.
double expected_border(double area, double length, std::int32_t parts) {
  if (parts == 1) return length;
  const double compact = kPerimeter * std::sqrt(area * parts);
  const double slices = length + 4 * (parts - 1) * area / length;
  return std::max(compact, slices);
}

/// The cost of a deviation from the mean work, in units of the expected border.
double imbalance_cost(double load) {
  const double over = std::max(0.0, load - 1.25);
  return 0.3 * (load - 1) * (load - 1) + 8 * over * over;
}

}  // namespace

/// All usable stations, or, of each stretch of the border, the one with the widest sector.
void CutSearch::select_stations() {
  selected_.clear();
  const auto& stations = outline_->stations;
  std::size_t usable = 0;
  for (const auto& s : stations) usable += s.usable;
  if (usable <= goal_.max_stations) {
    for (std::size_t i = 0; i < stations.size(); ++i)
      if (stations[i].usable) selected_.push_back(i);
    stride_ = 1;
    return;
  }
  const double stretch = outline_->length / static_cast<double>(goal_.max_stations);
  double end = stretch;
  bool any = false;
  for (std::size_t i = 0; i < stations.size(); ++i) {
    const auto& s = stations[i];
    while (s.length >= end) {
      end += stretch;
      any = false;
    }
    if (!s.usable) continue;
    if (!any) {
      selected_.push_back(i);
    } else {
      const auto& best = stations[selected_.back()];
      const bool wider = s.reflex != best.reflex ? s.reflex : false;
      if (wider) selected_.back() = i;
    }
    any = true;
  }
  stride_ = std::max<std::size_t>(1, stations.size() / selected_.size());
}

void CutSearch::rank(std::size_t i, std::size_t j, std::vector<Cut>& ranked) const {
  const auto& stations = outline_->stations;
  const auto &a = stations[i], &b = stations[j];
  const double dx = b.at.x - a.at.x, dy = b.at.y - a.at.y;
  if (!Outline::allows(a, dx, dy) || !Outline::allows(b, -dx, -dy)) return;
  const double share = outline_->share_between(i, j);
  if (!(share > 0 && share < 1)) return;
  const double fair =
      share / (share + goal_.bias * (1 - share));  // the share of the parts that corresponds to this share of the work
  const auto n = goal_.parts;
  const auto between = std::clamp(static_cast<std::int32_t>(std::lround(fair * n)), 1, n - 1);
  const double load_between = goal_.load * fair * n / between;
  const double load_rest = goal_.load * (1 - fair) * n / (n - between);
  const double length = std::sqrt(dx * dx + dy * dy);
  const double area_between = outline_->twice_area_between(i, j) / 2;
  if (!(area_between >= 0 && area_between <= outline_->area)) return;  // it crosses the border
  const double border_between = b.length - a.length;
  const double expected =
      expected_border(area_between, border_between + length, between) +
      expected_border(outline_->area - area_between, outline_->length - border_between + length, n - between);
  const double unit = kPerimeter * std::sqrt(outline_->area * n);
  const double depth = 1 - 2.0 * std::min(between, n - between) / n;
  const double cost =
      (expected + 0.3 * length) / unit + imbalance_cost(load_between) + imbalance_cost(load_rest) + 0.1 * depth * depth;
  ranked.push_back({i, j, between, share, cost});
}

void CutSearch::rank_pairs() {
  ranked_.clear();
  for (std::size_t k = 0; k < selected_.size(); ++k)
    for (std::size_t l = k + 1; l < selected_.size(); ++l) rank(selected_[k], selected_[l], ranked_);
}

bool CutSearch::stays_inside(std::size_t i, std::size_t j) const {
  const auto& stations = outline_->stations;
  const auto &s = stations[i], &t = stations[j];
  const Point &a = s.at, &b = t.at;
  const double dx = b.x - a.x, dy = b.y - a.y, squared_length = dx * dx + dy * dy;
  const double keep = goal_.clearance * std::min(outline_->spacing, std::sqrt(squared_length));
  const double keep_cross = keep * std::sqrt(squared_length);
  const Point low{std::min(a.x, b.x) - keep, std::min(a.y, b.y) - keep};
  const Point high{std::max(a.x, b.x) + keep, std::max(a.y, b.y) + keep};
  const auto touches_end = [&](const Outline::Station& end, const Point& u, const Point& v, SideId side) {
    return u == end.at || v == end.at || (!end.corner && PlanarMap::wall_of(side) == PlanarMap::wall_of(end.side));
  };
  SideId h = stations[0].side;
  do {
    const Point &u = map_->at(map_->start(h)), &v = map_->at(map_->end(h));
    const SideId side = h;
    h = map_->side(h).next;
    if (std::max(u.x, v.x) < low.x || std::min(u.x, v.x) > high.x || std::max(u.y, v.y) < low.y ||
        std::min(u.y, v.y) > high.y)
      continue;
    const double along = (u.x - a.x) * dx + (u.y - a.y) * dy;
    const double across = (u.y - a.y) * dx - (u.x - a.x) * dy;
    if (std::fabs(across) < keep_cross && along > 0 && along < squared_length && !(u == a) && !(u == b)) {
      const double nearest = std::min(squared_distance(u, a), squared_distance(u, b));
      if (across * across < 0.12 * nearest * squared_length) return false;
    }
    if (touches_end(s, u, v, side) || touches_end(t, u, v, side)) continue;
    const double at_u = orient2d(a, b, u), at_v = orient2d(a, b, v);
    if ((at_u > 0 && at_v > 0) || (at_u < 0 && at_v < 0)) continue;
    const double at_a = orient2d(u, v, a), at_b = orient2d(u, v, b);
    if ((at_a > 0 && at_b > 0) || (at_a < 0 && at_b < 0)) continue;
    return false;
  } while (h != stations[0].side);
  return true;
}

Cut CutSearch::first_inside(std::vector<Cut>& ranked) const {
  const auto worse = [](const Cut& a, const Cut& b) {
    if (a.cost != b.cost) return a.cost > b.cost;
    return a.first != b.first ? a.first > b.first : a.second > b.second;
  };
  std::make_heap(ranked.begin(), ranked.end(), worse);
  while (!ranked.empty()) {
    std::pop_heap(ranked.begin(), ranked.end(), worse);
    const Cut cut = ranked.back();
    if (stays_inside(cut.first, cut.second)) return cut;
    ranked.pop_back();
  }
  return {};
}

/// Tries the neighbors of a cut's ends that the selection left out, in decreasing steps.
Cut CutSearch::refine(Cut cut) {
  const auto count = static_cast<std::ptrdiff_t>(outline_->stations.size());
  for (std::ptrdiff_t step = static_cast<std::ptrdiff_t>(stride_ + 1) / 2; stride_ > 1 && step >= 1; step /= 2) {
    nearby_.clear();
    for (std::ptrdiff_t p = -2; p <= 2; ++p)
      for (std::ptrdiff_t q = -2; q <= 2; ++q) {
        const auto i = static_cast<std::ptrdiff_t>(cut.first) + p * step;
        const auto j = static_cast<std::ptrdiff_t>(cut.second) + q * step;
        if (i < 0 || j >= count || i >= j || (p == 0 && q == 0)) continue;
        const auto u = static_cast<std::size_t>(i), v = static_cast<std::size_t>(j);
        if (outline_->stations[u].usable && outline_->stations[v].usable) rank(u, v, nearby_);
      }
    std::erase_if(nearby_, [&](const Cut& c) { return c.cost >= cut.cost; });
    if (const Cut better = first_inside(nearby_)) cut = better;
  }
  return cut;
}

Cut CutSearch::find(const PlanarMap& map, const Outline& outline, const CutGoal& goal) {
  map_ = &map;
  outline_ = &outline;
  goal_ = goal;
  select_stations();
  rank_pairs();
  const Cut cut = first_inside(ranked_);
  return cut ? refine(cut) : cut;
}

}  // namespace driftmesh
