#include "raster/level_outline.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "base/disjoint_sets.hpp"

namespace driftmesh {
namespace {

constexpr double kWithoutValue = -std::numeric_limits<double>::infinity();
constexpr std::int64_t kKept = 64;  // every so many points along a side of the rectangle, one is kept

double twice_area(const PolygonRing& ring) {
  double sum = 0;
  for (std::size_t k = 0; k < ring.size(); ++k) {
    const Point &p = ring[k], &q = ring[(k + 1) % ring.size()], &o = ring.front();
    sum += (p.x - o.x) * (q.y - o.y) - (p.y - o.y) * (q.x - o.x);
  }
  return sum;
}

}  // namespace

/// Four neighbors, counterclockwise from the lower left one; side s runs from corner s to the next one.
struct LevelOutline::Square {
  std::array<double, 4> beyond;
  std::array<Vertex, 4> corner, crossed;  // crossed: only of sides with one end inside

  [[nodiscard]] bool inside(std::size_t corner_at) const { return beyond[corner_at % 4] > 0; }
  [[nodiscard]] bool is_crossed(std::size_t side) const { return inside(side) != inside(side + 1); }
  /// Whether the corners inside face each other, and are two parts.
  [[nodiscard]] bool is_split() const {
    if (inside(0) != inside(2) || inside(1) != inside(3) || inside(0) == inside(1)) return false;
    const std::size_t in = inside(0) ? 0 : 1;
    return !(beyond[in] * beyond[in + 2] > beyond[in + 1] * beyond[(in + 3) % 4]);
  }
  /// Which of the two parts a corner belongs to.
  [[nodiscard]] static std::size_t part_of(bool split, std::size_t corner_at) {
    return split && corner_at % 4 >= 2 ? 1 : 0;
  }
  /// The corner inside at an end of a side, if some length of the side is inside; otherwise 4.
  [[nodiscard]] std::size_t corner_along(std::size_t side) const {
    const std::size_t next = (side + 1) % 4;
    if (inside(side)) return inside(next) || crossed[side].id != corner[side].id ? side : 4;
    return inside(next) && crossed[side].id != corner[next].id ? next : 4;
  }
};

struct LevelOutline::Loop {
  std::int32_t part;
  std::vector<Vertex> vertices;
};

LevelOutline::LevelOutline(const RasterFrame& frame, double level, bool below)
    : frame_(frame), level_(level), sign_(below ? -1 : 1), row_(frame.rows - 1) {
  const auto squares = static_cast<std::size_t>(std::max<std::int64_t>(frame.columns - 1, 0));
  above_.assign(2 * squares, -1);
  here_ = above_;
}

LevelOutline::PointId LevelOutline::id_of(std::int64_t i, std::int64_t j) const {
  return 3 * static_cast<PointId>(j * frame_.columns + i);
}

LevelOutline::Vertex LevelOutline::point(std::int64_t i, std::int64_t j) const {
  return {id_of(i, j),
          {frame_.first.x + static_cast<double>(i) * frame_.dx, frame_.first.y + static_cast<double>(j) * frame_.dy}};
}

/// Between a point and the next one in a direction, the same whichever square asks.
LevelOutline::Vertex LevelOutline::crossing(std::int64_t i, std::int64_t j, bool upward, double here,
                                            double next) const {
  const Vertex a = point(i, j), b = upward ? point(i, j + 1) : point(i + 1, j);
  const double t = std::isinf(here) || std::isinf(next) ? 0.5 : here / (here - next);
  if (t < kSnap) return a;
  if (t > 1 - kSnap) return b;
  const Point at =
      upward ? Point{a.at.x, a.at.y + t * (b.at.y - a.at.y)} : Point{a.at.x + t * (b.at.x - a.at.x), a.at.y};
  return {a.id + (upward ? 2 : 1), at};
}

void LevelOutline::add_row(std::span<const float> values) {
  lower_.resize(values.size());
  std::ranges::transform(values, lower_.begin(), [this](float value) {
    return std::isnan(value) ? kWithoutValue : sign_ * (static_cast<double>(value) - level_);
  });
  if (!upper_.empty())
    for (std::int64_t i = 0; i + 1 < frame_.columns; ++i) add_square(i, row_);
  std::swap(upper_, lower_);
  std::swap(above_, here_);
  --row_;
}

void LevelOutline::add_square(std::int64_t i, std::int64_t j) {
  const auto k = static_cast<std::size_t>(i);
  Square square{{lower_[k], lower_[k + 1], upper_[k + 1], upper_[k]}, {}, {}};
  here_[2 * k] = here_[2 * k + 1] = -1;
  const auto inside = std::ranges::count_if(square.beyond, [](double beyond) { return beyond > 0; });
  if (inside == 0) return;
  square.corner = {point(i, j), point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)};
  if (inside < 4) {
    if (square.is_crossed(0)) square.crossed[0] = crossing(i, j, false, square.beyond[0], square.beyond[1]);
    if (square.is_crossed(1)) square.crossed[1] = crossing(i + 1, j, true, square.beyond[1], square.beyond[2]);
    if (square.is_crossed(2)) square.crossed[2] = crossing(i, j + 1, false, square.beyond[3], square.beyond[2]);
    if (square.is_crossed(3)) square.crossed[3] = crossing(i, j, true, square.beyond[0], square.beyond[3]);
  }
  connect(square, i, j);
  add_edges(square, i, j);
}

/// Numbers the parts of a square: as those on its left and above it, where sides with some length inside lead there.
void LevelOutline::connect(const Square& square, std::int64_t i, std::int64_t j) {
  const auto k = static_cast<std::size_t>(i);
  const bool split = square.is_split();
  const auto join = [&](std::size_t side, std::size_t there, const std::vector<std::int32_t>& parts) {
    const std::size_t corner = square.corner_along(side);
    if (corner == 4) return;
    // An upper left corner is the upper right one of the square on the left, which may have two parts.
    const bool second = side == 3 && corner == 3 && parts[2 * there + 1] >= 0;
    const std::int32_t other = parts[2 * there + (second ? 1 : 0)];
    std::int32_t& own = here_[2 * k + Square::part_of(split, corner)];
    if (own < 0)
      own = other;
    else if (own != other)
      same_.emplace_back(own, other);
  };
  if (i > 0) join(3, k - 1, here_);
  if (j + 2 < frame_.rows) join(2, k, above_);
  for (std::size_t corner = 0; corner < 4; ++corner)
    if (std::int32_t& own = here_[2 * k + Square::part_of(split, corner)]; square.inside(corner) && own < 0)
      own = count_++;
}

void LevelOutline::add_edges(const Square& square, std::int64_t i, std::int64_t j) {
  const bool split = square.is_split();
  const auto add = [&](const Vertex& from, const Vertex& to, std::size_t corner) {
    const std::int32_t part = here_[2 * static_cast<std::size_t>(i) + Square::part_of(split, corner)];
    if (from.id != to.id) edges_.push_back({from, to.id, part});
  };
  const std::array<bool, 4> at_side{j == 0, i + 2 == frame_.columns, j + 2 == frame_.rows, i == 0};
  for (std::size_t s = 0; s < 4; ++s) {
    const std::size_t next = (s + 1) % 4;
    if (square.inside(s) && !square.inside(next)) {
      // The outline leaves the inside here, and comes back at the next side that is crossed, or, around a part by
      // itself, at the side before.
      std::size_t back = split ? (s + 3) % 4 : next;
      while (!square.is_crossed(back)) back = (back + 1) % 4;
      add(square.crossed[s], square.crossed[back], s);
    }
    if (!at_side[s]) continue;
    if (square.inside(s))
      add(square.corner[s], square.inside(next) ? square.corner[next] : square.crossed[s], s);
    else if (square.inside(next))
      add(square.crossed[s], square.corner[next], next);
  }
}

/// Without those that occur in both directions, where what lay between them was narrower than a snap, so that the parts
/// on both sides are one; sorted by their beginnings, with the final numbers of parts.
std::vector<LevelOutline::Edge> LevelOutline::edges_of_parts() {
  std::vector<Edge> edges = std::exchange(edges_, {});
  const auto ends = [](const Edge& e) { return std::minmax(e.from.id, e.to); };
  std::ranges::sort(edges, [&](const Edge& a, const Edge& b) { return ends(a) < ends(b); });
  DisjointSets<> sets(static_cast<std::size_t>(count_));
  for (const auto& [a, b] : same_) sets.join(a, b);
  std::vector<Edge> left;
  for (std::size_t k = 0; k < edges.size(); ++k) {
    if (k + 1 < edges.size() && ends(edges[k]) == ends(edges[k + 1])) {
      sets.join(edges[k].part, edges[k + 1].part);
      ++k;
    } else {
      left.push_back(edges[k]);
    }
  }
  for (Edge& edge : left) edge.part = sets.find(edge.part);
  std::ranges::sort(left, [](const Edge& a, const Edge& b) {
    return std::pair{a.from.id, a.to} < std::pair{b.from.id, b.to};
  });
  return left;
}

/// Follows the edges of each part; where several meet, the one that turns most to the left. Whenever a walk comes back
/// to a point, that is a loop.
std::vector<LevelOutline::Loop> LevelOutline::loops_of(const std::vector<Edge>& edges) const {
  std::vector<bool> used(edges.size());
  const auto begin_of = [&](PointId id) {
    return static_cast<std::size_t>(std::ranges::lower_bound(edges, id, {}, [](const Edge& e) { return e.from.id; }) -
                                    edges.begin());
  };
  const auto place_of = [&](PointId id) { return edges[begin_of(id)].from.at; };
  const auto turn = [&](const Edge& e, const Edge& next) {
    const Point at = next.from.at, behind = place_of(next.to);
    const Point in{(at.x - e.from.at.x) / frame_.dx, (at.y - e.from.at.y) / frame_.dy};
    const Point out{(behind.x - at.x) / frame_.dx, (behind.y - at.y) / frame_.dy};
    return std::atan2(in.x * out.y - in.y * out.x, in.x * out.x + in.y * out.y);
  };
  const auto next_of = [&](const Edge& e) {
    std::size_t best = edges.size();
    for (std::size_t k = begin_of(e.to); k < edges.size() && edges[k].from.id == e.to; ++k)
      if (!used[k] && edges[k].part == e.part && (best == edges.size() || turn(e, edges[k]) > turn(e, edges[best])))
        best = k;
    return best;
  };
  std::vector<Loop> loops;
  std::vector<std::size_t> walk;
  std::map<PointId, std::size_t> where;  // in the walk
  for (std::size_t start = 0; start < edges.size(); ++start) {
    for (std::size_t at = start; at < edges.size() && !used[at]; at = next_of(edges[at])) {
      used[at] = true;
      where[edges[at].from.id] = walk.size();
      walk.push_back(at);
      const auto met = where.find(edges[at].to);
      if (met == where.end()) continue;
      const std::size_t first = met->second;
      Loop& loop = loops.emplace_back(Loop{edges[at].part, {}});
      for (std::size_t k = first; k < walk.size(); ++k) {
        loop.vertices.push_back(edges[walk[k]].from);
        loop.vertices.back().is_shared = begin_of(loop.vertices.back().id + 1) - begin_of(loop.vertices.back().id) > 1;
        where.erase(edges[walk[k]].from.id);
      }
      walk.resize(first);
    }
  }
  return loops;
}

/// Leaves out points along the sides of the rectangle, which tell nothing.
PolygonRing LevelOutline::without_points_on_sides(const std::vector<Vertex>& vertices) const {
  const Point low = point(0, 0).at, high = point(frame_.columns - 1, frame_.rows - 1).at;
  const auto tells_nothing = [&](const Point& a, const Vertex& here, const Point& c) {
    const Point& b = here.at;
    const bool across = a.y == b.y && b.y == c.y && (b.y == low.y || b.y == high.y);
    const bool upward = a.x == b.x && b.x == c.x && (b.x == low.x || b.x == high.x);
    const auto number = static_cast<std::int64_t>(here.id / 3);
    const std::int64_t along = across ? number % frame_.columns : number / frame_.columns;
    return (across || upward) && !here.is_shared && (here.id % 3 != 0 || along % kKept != 0);
  };
  PolygonRing ring;
  for (std::size_t k = 0; k < vertices.size(); ++k) {
    const Vertex &before = vertices[(k + vertices.size() - 1) % vertices.size()], &here = vertices[k],
                 &behind = vertices[(k + 1) % vertices.size()];
    if (!tells_nothing(before.at, here, behind.at)) ring.push_back(here.at);
  }
  return ring;
}

std::vector<LevelPart> LevelOutline::parts() {
  std::map<std::int32_t, std::vector<std::pair<double, PolygonRing>>> rings;
  for (const Loop& loop : loops_of(edges_of_parts())) {
    PolygonRing ring = without_points_on_sides(loop.vertices);
    const double twice = twice_area(ring);
    rings[loop.part].emplace_back(twice, std::move(ring));
  }
  std::vector<LevelPart> parts;
  for (auto& [number, of_part] : rings) {
    std::ranges::stable_sort(of_part, std::ranges::greater{}, [](const auto& ring) { return ring.first; });
    LevelPart& part = parts.emplace_back();
    for (auto& [twice, ring] : of_part) {
      part.area += twice / 2;
      part.rings.push_back(std::move(ring));
    }
  }
  std::ranges::stable_sort(parts, std::ranges::greater{}, &LevelPart::area);
  return parts;
}

}  // namespace driftmesh
