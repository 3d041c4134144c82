#include "decompose/outline.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geometry/midpoint.hpp"
#include "geometry/predicates.hpp"
#include "geometry/triangle_geometry.hpp"

namespace driftmesh {
namespace {

Point direction(const Point& from, const Point& to) {
  const double length = std::sqrt(squared_distance(from, to));
  return {(to.x - from.x) / length, (to.y - from.y) / length};
}

Point rotated(const Point& d, double cosine, double sine) {
  return {d.x * cosine - d.y * sine, d.x * sine + d.y * cosine};
}

bool are_opposite(const Point& u, const Point& v) {
  constexpr double kNearly = -0.9999;
  return u.x * v.x + u.y * v.y < kNearly;
}

/// Counterclockwise from `forward` to `backward`: the angle inside the piece, in (0, 2 pi].
double interior_angle(const Point& forward, const Point& backward) {
  const double angle =
      std::atan2(forward.x * backward.y - forward.y * backward.x, forward.x * backward.x + forward.y * backward.y);
  return angle > 0 ? angle : angle + 2 * std::numbers::pi;
}

/// The sectors in which separators may leave stations.
class Sectors {
 public:
  explicit Sectors(double angle) : angle_(angle), cosine_(std::cos(angle)), sine_(std::sin(angle)) {}

  /// `forward` and `backward`: unit vectors along the border, `interior`: the angle between them.
  void set(Outline::Station& s, const Point& forward, const Point& backward, double interior) const {
    const double sector = interior - 2 * angle_;
    s.usable = sector > 0;
    s.reflex = sector >= std::numbers::pi;
    s.first = rotated(forward, cosine_, sine_);
    s.last = rotated(backward, cosine_, -sine_);
  }

 private:
  double angle_, cosine_, sine_;
};

/// The number of equal parts into which places divide a wall.
int parts_of(const PlanarMap& map, SideId side, double length, double spacing) {
  const PlanarMap::Wall& wall = map.wall(side);
  if (map.whole_segments && wall.kind == PlanarMap::Kind::kInput) return 1;
  const double parts = std::floor(length / spacing + 0.3);
  if (parts < 2) return 1;
  return wall.shell != kNone ? 2 : static_cast<int>(std::min(parts, 1e6));
}

SideId split_at(PlanarMap& map, SideId h, const Point& p, VertexOrigin what) {
  return map.split(h, map.add_point(p, what));
}

/// The first number that no shell and no shell end has.
std::int32_t fresh_shell_name(const PlanarMap& map) {
  std::int32_t name = 0;
  for (const PlanarMap::Wall& w : map.walls) name = std::max(name, w.shell + 1);
  for (const VertexOrigin o : map.origin)
    if (is_shell_end(o)) name = std::max(name, o - kShellEnd + 1);
  return name;
}

/// Halves every wall of a shell: the halves are two new shells, and their common ends lie on a new circle.
void halve_shell(PlanarMap& map, std::int32_t shell) {
  const std::int32_t name = fresh_shell_name(map);
  for (const WallId w : ids_of(map.walls)) {  // without those that are added
    if (map.walls[w].shell != shell) continue;
    const SideId h = PlanarMap::first_side(w);
    const SideId rest = split_at(map, h, midpoint(map.at(map.start(h)), map.at(map.end(h))), kShellEnd + name);
    map.wall(h).shell = name;
    map.wall(rest).shell = name + 1;
  }
}

/// Twice the area between o and edge ab.
double swept_from(const Point& o, const Point& a, const Point& b) {
  return (a.x - o.x) * (b.y - o.y) - (a.y - o.y) * (b.x - o.x);
}

/// visit(side, where it ends)
template <class Visit>
void for_each_side(const Loop& loop, const Visit& visit) {
  for (std::size_t k = 0; k + 1 < loop.size(); ++k) visit(loop[k], loop[k + 1].at);
  visit(loop.back(), loop.front().at);
}

}  // namespace

double Outline::sampled_share(const Station& a, const Station& b) const {
  return (b.crossed_work - a.crossed_work + crossing_work(samples, b.at, a.at)) / work;
}

void set_samples(Outline& outline, WorkSamples samples) {
  outline.samples = std::move(samples);
  outline.work = 0;
  for (const WorkSample& s : outline.samples) outline.work += s.work;
  double crossed = 0;
  auto& stations = outline.stations;
  for (std::size_t i = 0; i < stations.size() && !outline.samples.empty(); ++i) {
    stations[i].crossed_work = crossed;
    crossed += crossing_work(outline.samples, stations[i].at, stations[i + 1 < stations.size() ? i + 1 : 0].at);
  }
}

void read_loop(const PlanarMap& map, SideId side, Loop& loop) {
  loop.clear();
  SideId h = side;
  do {
    loop.push_back({map.at(map.start(h)), h});
    h = map.side(h).next;
  } while (h != side);
}

std::vector<Point> border_of(const PlanarMap& map, SideId side) {
  Loop loop;
  read_loop(map, side, loop);
  std::vector<Point> border;
  for (const LoopSide& s : loop) border.push_back(s.at);
  return border;
}

double area_inside(const Loop& loop) {
  const Point o = loop.front().at;
  double twice_area = 0;
  for_each_side(loop, [&](const LoopSide& from, const Point& b) { twice_area += swept_from(o, from.at, b); });
  return twice_area / 2;
}

PieceSize measure(const Loop& loop) {
  const Point o = loop.front().at;
  double twice_area = 0, length = 0;
  for_each_side(loop, [&](const LoopSide& from, const Point& b) {
    const Point& a = from.at;
    twice_area += swept_from(o, a, b);
    length += std::sqrt(squared_distance(a, b));
  });
  return {twice_area / 2, length};
}

void place_stations(const PlanarMap& map, double spacing, double angle, Outline& outline) {
  const Sectors sectors(angle);
  auto& stations = outline.stations;
  stations.clear();
  outline.spacing = spacing;
  const Point o = outline.loop.front().at;
  double length = 0, twice_area = 0;
  Point backward = direction(o, outline.loop.back().at);
  for_each_side(outline.loop, [&](const LoopSide& from, const Point& b) {
    const Point& a = from.at;
    const double whole = std::sqrt(squared_distance(a, b));
    const double swept = swept_from(o, a, b);
    const Point forward{(b.x - a.x) / whole, (b.y - a.y) / whole};
    const int parts = parts_of(map, from.side, whole, spacing);
    Outline::Station corner;
    corner.at = a;
    corner.side = from.side;
    corner.corner = true;
    corner.opposite = map.origin[map.start(from.side)] == kNone && are_opposite(forward, backward);
    corner.length = length;
    corner.twice_area = twice_area;
    sectors.set(corner, forward, backward, interior_angle(forward, backward));
    stations.push_back(corner);
    backward = {-forward.x, -forward.y};
    Outline::Station place = corner;
    place.corner = place.opposite = false;
    if (parts > 1) sectors.set(place, forward, backward, std::numbers::pi);
    for (int k = 1; k < parts; ++k) {
      const double t = static_cast<double>(k) / parts;
      place.at = {snap_to_zero(a.x + t * (b.x - a.x)), snap_to_zero(a.y + t * (b.y - a.y))};
      if (2 * k == parts) place.at = midpoint(a, b);
      place.length = length + t * whole;
      place.twice_area = twice_area + t * swept;
      stations.push_back(place);
    }
    length += whole;
    twice_area += swept;
  });
  outline.length = length;
  outline.area = twice_area / 2;
}

SideId realize(PlanarMap& map, const Outline::Station& station) {
  if (station.corner) return station.side;
  // If both ends of a separator are places on the same shell, the first one has halved it already.
  const auto found = [&]() -> SideId {
    if (map.at(map.start(station.side)) == station.at) return station.side;
    if (map.at(map.end(station.side)) == station.at) return map.side(station.side).next;
    return kNone;
  };
  if (const SideId h = found(); h != kNone) return h;
  const std::int32_t shell = map.wall(station.side).shell;
  if (shell == kNone) return split_at(map, station.side, station.at, kNone);
  halve_shell(map, shell);
  return found();
}

}  // namespace driftmesh
