#include "decompose/cut_search.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <span>

#include "base/wide.hpp"
#include "decompose/separator_room.hpp"
#include "geometry/predicates.hpp"
#include "geometry/triangle_geometry.hpp"

namespace driftmesh {
namespace {

constexpr double kNoLimit = std::numeric_limits<double>::infinity();

constexpr std::size_t kManySides = 512;
constexpr std::size_t kWord = 64;

constexpr std::array<std::uint64_t, kWord> kBits = [] {
  std::array<std::uint64_t, kWord> bits{};
  for (std::size_t i = 0; i < kWord; ++i) bits[i] = std::uint64_t{1} << i;
  return bits;
}();

/// A bit for each station that k can be joined with, among those in some blocks from `begin` on, at most a word.
DRIFTMESH_WIDE std::uint64_t joinable(const StationColumns& columns, std::size_t k, std::size_t begin,
                                      std::size_t blocks) {
  const double *const x = &columns.x[begin], *const y = &columns.y[begin];
  const double *const first_x = &columns.first_x[begin], *const first_y = &columns.first_y[begin];
  const double *const last_x = &columns.last_x[begin], *const last_y = &columns.last_y[begin];
  const double ax = columns.x[k], ay = columns.y[k];
  const double from_x = columns.first_x[k], from_y = columns.first_y[k];
  const double to_x = columns.last_x[k], to_y = columns.last_y[k];
  std::uint64_t found = 0;
  for (std::size_t l = 0; l < blocks * StationColumns::kBlock; ++l) {
    const double dx = x[l] - ax, dy = y[l] - ay;
    const double leaving = std::min(from_x * dy - from_y * dx, dx * to_y - dy * to_x);
    const double arriving = std::min(first_y[l] * dx - first_x[l] * dy, last_x[l] * dy - last_y[l] * dx);
    const double apart = std::max(std::fabs(dx), std::fabs(dy));  // two corners may be one point
    found |= std::min(leaving, arriving) >= 0 && apart > 0 ? kBits[l] : 0;
  }
  return found;
}

/// Calls visit(l) for the stations l > k that station k can be joined with.
template <class Visit>
void for_each_joinable(const StationColumns& columns, std::size_t k, const Visit& visit) {
  constexpr std::size_t kBlock = StationColumns::kBlock;
  for (std::size_t begin = (k + 1) / kBlock * kBlock; begin < columns.size(); begin += kWord) {
    std::uint64_t found = joinable(columns, k, begin, std::min(columns.size() - begin, kWord) / kBlock);
    if (begin <= k) found &= ~std::uint64_t{0} << (k + 1 - begin);
    for (; found != 0; found &= found - 1) visit(begin + static_cast<std::size_t>(std::countr_zero(found)));
  }
}

std::size_t following(const Loop& loop, std::size_t k) {
  return k + 1 < loop.size() ? k + 1 : 0;
}

}  // namespace

/// All usable stations, or, of each stretch of the border, the one with the widest sector.
void CutSearch::select_stations() {
  selected_.clear();
  const auto& stations = outline_->stations;
  std::size_t usable = 0;
  for (const auto& s : stations) usable += s.usable;
  if (usable <= goal_.max_stations) {
    for (std::uint32_t i = 0; i < stations.size(); ++i)
      if (stations[i].usable) selected_.push_back(i);
    stride_ = 1;
    return;
  }
  const double stretch = outline_->length / static_cast<double>(goal_.max_stations);
  double end = stretch;
  bool any = false;
  for (std::uint32_t i = 0; i < stations.size(); ++i) {
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

void StationColumns::set(const Outline& outline, std::span<const std::uint32_t> selected) {
  const std::size_t count = selected.size(), whole = (count + kBlock - 1) / kBlock * kBlock;
  for (auto* column : {&x, &y, &first_x, &first_y, &last_x, &last_y}) {
    column->resize(whole);
    std::fill(column->begin() + static_cast<std::ptrdiff_t>(count), column->end(),
              std::numeric_limits<double>::quiet_NaN());
  }
  for (std::size_t k = 0; k < count; ++k) {
    const Outline::Station& s = outline.stations[selected[k]];
    const double limits = s.reflex ? 0 : 1;  // without limits here, the sector is left to allows()
    x[k] = s.at.x;
    y[k] = s.at.y;
    first_x[k] = limits * s.first.x;
    first_y[k] = limits * s.first.y;
    last_x[k] = limits * s.last.x;
    last_y[k] = limits * s.last.y;
  }
}

bool CutSearch::allows(std::size_t i, std::size_t j) const {
  const Outline::Station &a = outline_->stations[i], &b = outline_->stations[j];
  const double dx = b.at.x - a.at.x, dy = b.at.y - a.at.y;
  return (dx != 0 || dy != 0) && Outline::allows(a, dx, dy) && Outline::allows(b, -dx, -dy);
}

/// All pairs of selected stations whose sectors allow a separator.
void CutSearch::collect_pairs() {
  candidates_.clear();
  columns_.set(*outline_, selected_);
  bool any_reflex = false;
  for (std::size_t k = 0; k < selected_.size(); ++k) {
    any_reflex |= outline_->stations[selected_[k]].reflex;
    for_each_joinable(columns_, k, [&](std::size_t l) { candidates_.add(selected_[k], selected_[l]); });
  }
  if (any_reflex) candidates_.keep([this](std::size_t i, std::size_t j) { return allows(i, j); });
}

void CutSearch::set_sides() {
  const Loop& loop = outline_->loop;
  sides_ = {};
  if (loop.size() <= kManySides) return;
  std::vector<Box> boxes(loop.size());
  for (std::size_t k = 0; k < loop.size(); ++k) boxes[k] = Box::around(loop[k].at, loop[following(loop, k)].at);
  sides_ = BoxTree(boxes);
}

bool CutSearch::stays_inside(std::size_t i, std::size_t j) const {
  const auto& stations = outline_->stations;
  const auto &s = stations[i], &t = stations[j];
  const Point &a = s.at, &b = t.at;
  const double length = std::sqrt(squared_distance(a, b));
  const SeparatorRoom room(a, b, goal_.clearance * std::min(outline_->spacing, length));
  const double keep = room.height();
  const Box around = Box::around(a, b, keep);
  const auto touches_end = [&](const Outline::Station& end, const Point& u, const Point& v, SideId side) {
    return u == end.at || v == end.at || (!end.corner && PlanarMap::wall_of(side) == PlanarMap::wall_of(end.side));
  };
  const Loop& loop = outline_->loop;
  const auto is_blocked_by = [&](std::size_t k) {
    const Point &u = loop[k].at, &v = loop[following(loop, k)].at;
    const SideId side = loop[k].side;
    if (!around.overlaps(Box::around(u, v))) return false;
    if (!(u == a) && !(u == b) && room.contains(u)) return true;
    if (touches_end(s, u, v, side) || touches_end(t, u, v, side)) return false;
    if (room.is_entered_by(u, v)) return true;
    const double at_u = orient2d(a, b, u), at_v = orient2d(a, b, v);
    if ((at_u > 0 && at_v > 0) || (at_u < 0 && at_v < 0)) return false;
    const double at_a = orient2d(u, v, a), at_b = orient2d(u, v, b);
    return !((at_a > 0 && at_b > 0) || (at_a < 0 && at_b < 0));
  };
  if (loop.size() <= kManySides) {
    for (std::size_t k = 0; k < loop.size(); ++k)
      if (is_blocked_by(k)) return false;
    return true;
  }
  bool is_blocked = false;
  const double reach = 1.01 * keep * length;  // with room for rounding
  const auto near = [&](const Box& box) {
    if (is_blocked || !around.overlaps(box)) return false;
    const Point middle = box.center();
    const double across = (b.x - a.x) * (middle.y - a.y) - (b.y - a.y) * (middle.x - a.x);
    const double half = std::fabs(b.x - a.x) * (box.high.y - middle.y) + std::fabs(b.y - a.y) * (box.high.x - middle.x);
    return std::fabs(across) <= half + reach;
  };
  sides_.search(near, [&](std::int32_t k) { is_blocked = is_blocked || is_blocked_by(static_cast<std::size_t>(k)); });
  return !is_blocked;
}

Cut CutSearch::best_inside(double limit) {
  candidates_.rank(*outline_, goal_);
  return candidates_.best(limit, [this](std::size_t i, std::size_t j) { return stays_inside(i, j); });
}

/// Tries the neighbors of a cut's ends that the selection left out, in decreasing steps.
Cut CutSearch::refine(Cut cut) {
  const auto count = static_cast<std::ptrdiff_t>(outline_->stations.size());
  for (std::ptrdiff_t step = static_cast<std::ptrdiff_t>(stride_ + 1) / 2; stride_ > 1 && step >= 1; step /= 2) {
    candidates_.clear();
    for (std::ptrdiff_t p = -2; p <= 2; ++p)
      for (std::ptrdiff_t q = -2; q <= 2; ++q) {
        const auto i = static_cast<std::ptrdiff_t>(cut.first) + p * step;
        const auto j = static_cast<std::ptrdiff_t>(cut.second) + q * step;
        if (i < 0 || j >= count || i >= j || (p == 0 && q == 0)) continue;
        const auto u = static_cast<std::size_t>(i), v = static_cast<std::size_t>(j);
        if (outline_->stations[u].usable && outline_->stations[v].usable && allows(u, v)) candidates_.add(u, v);
      }
    if (const Cut better = best_inside(cut.cost)) cut = better;
  }
  return cut;
}

Cut CutSearch::find(const Outline& outline, const CutGoal& goal) {
  outline_ = &outline;
  goal_ = goal;
  set_sides();
  select_stations();
  collect_pairs();
  const Cut cut = best_inside(kNoLimit);
  return cut ? refine(cut) : cut;
}

}  // namespace driftmesh
