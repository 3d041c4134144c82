#include "decompose/star.hpp"

#include <algorithm>
#include <cmath>

namespace driftmesh {
namespace {

constexpr double kAnyAngle = 2;  // no cosine has this square

double cross(const Point& a, const Point& b) {
  return a.x * b.y - a.y * b.x;
}
double dot(const Point& a, const Point& b) {
  return a.x * b.x + a.y * b.y;
}
Point difference(const Point& a, const Point& b) {
  return {a.x - b.x, a.y - b.y};
}

/// The angle from `first` counterclockwise to `last`, as far as comparisons need it.
class Angle {
 public:
  Angle(const Point& first, const Point& last)
      : reflex_(cross(first, last) < 0), dot_(dot(first, last)), squares_(dot(first, first) * dot(last, last)) {}

  /// The limit that keeps this angle, or more if `limit` asks for less.
  [[nodiscard]] double limit(double limit) const {
    if (dot_ <= 0) return limit;
    return reflex_ ? kAnyAngle : std::max(limit, dot_ * dot_ / squares_);
  }
  /// Whether the angle is wide enough. One that has become negative, which looks like one above 270 degrees, is not.
  [[nodiscard]] bool is_within(double limit) const {
    return limit == kAnyAngle || dot_ <= 0 || (!reflex_ && dot_ * dot_ <= limit * squares_);
  }

 private:
  bool reflex_;
  double dot_, squares_;
};

/// Whether p lies beside wall uw, nearer than `keep`.
bool is_beside(const Point& p, const Point& u, const Point& w, double keep) {
  const Point d = difference(w, u), to = difference(p, u);
  const double along = dot(to, d), squared_length = dot(d, d), across = cross(d, to);
  return along > 0 && along < squared_length && across * across < keep * keep * squared_length;
}

/// Whether two walls meet other than at n.
bool crosses(const Point& p, const Point& n, const Point& u, const Point& w) {
  if (std::max(u.x, w.x) < std::min(p.x, n.x) || std::min(u.x, w.x) > std::max(p.x, n.x) ||
      std::max(u.y, w.y) < std::min(p.y, n.y) || std::min(u.y, w.y) > std::max(p.y, n.y))
    return false;
  const Point d = difference(n, p), e = difference(w, u);
  return cross(d, difference(u, p)) * cross(d, difference(w, p)) <= 0 &&
         cross(e, difference(p, u)) * cross(e, difference(n, u)) <= 0;
}

}  // namespace

Star::Star(const PlanarMap& map, const IdVector<SideId, PieceId>& piece_of, double angle)
    : map_(map), piece_of_(piece_of), limit_(std::cos(angle) * std::cos(angle) * (1 - 1e-9)) {}

bool Star::read(SideId side) {
  return read_around(side, kNone);
}

bool Star::read_without(SideId side) {
  return read_around(side, side);
}

/// Reads walls counterclockwise, from the border of the domain if the center is on it. Those at the other end of the
/// `merged` one take its place.
bool Star::read_around(SideId side, SideId merged) {
  origin_ = map_.at(map_.start(side));
  count_ = 0;
  const auto next = [this](SideId h) { return PlanarMap::twin(map_.side(h).previous); };
  SideId first = side;
  while (map_.side(PlanarMap::twin(first)).in_domain()) {
    first = map_.side(PlanarMap::twin(first)).next;
    if (first == side) break;
  }
  SideId h = first;
  do {
    if (h != merged && !add(h)) return false;
    const SideId back = PlanarMap::twin(h);
    for (SideId s = next(back); h == merged && s != back; s = next(s))
      if (!add(s)) return false;
    if (!map_.side(h).in_domain()) break;
    h = next(h);
  } while (h != first);
  set_freedom(side);
  for (std::size_t k = 0; k < count_; ++k) read_spoke(spokes_[k]);
  for (std::size_t k = 0; k < count_; ++k) read_sector(k);
  has_limits_ = false;
  return true;
}

bool Star::add(SideId side) {
  if (count_ == kMostSpokes) return false;
  spokes_[count_++].side = side;
  return true;
}

/// New points in the middle of a segment slide along it; those of shells lie on common circles.
void Star::set_freedom(SideId side) {
  freedom_ = map_.origin[map_.start(side)] == kNone ? Freedom::kRoams : Freedom::kStays;
  for (const Spoke& s : spokes()) {
    if (freedom_ == Freedom::kStays || !is_input(s.side)) continue;
    const Point d = relative(map_.end(s.side));
    const double length = std::sqrt(dot(d, d));
    along_ = {d.x / length, d.y / length};
    freedom_ = map_.wall(s.side).shell == kNone ? Freedom::kSlides : Freedom::kStays;
  }
}

void Star::read_spoke(Spoke& spoke) {
  spoke.separates = !is_input(spoke.side);
  spoke.end = relative(map_.end(spoke.side));
  spoke.start = relative(map_.start(spoke.side));
}

void Star::read_sector(std::size_t k) {
  const Spoke &from = spokes_[k], &to = after(k);
  sectors_[k].piece = piece_of_[from.side];
  sectors_[k].swept = cross(to.end, to.start) + cross(to.start, from.start) + cross(from.start, from.end);
}

void Star::set_limits(Spoke& spoke) {
  const SideId h = spoke.side, back = PlanarMap::twin(h);
  spoke.left_limit = spoke.right_limit = kAnyAngle;
  if (!spoke.separates || map_.side(h).next == back) return;
  spoke.left = relative(map_.end(map_.side(h).next));
  spoke.right = relative(map_.start(map_.side(back).previous));
  const Point home = difference(spoke.start, spoke.end);
  spoke.left_limit = Angle(difference(spoke.left, spoke.end), home).limit(limit_);
  spoke.right_limit = Angle(home, difference(spoke.right, spoke.end)).limit(limit_);
}

void Star::set_limit(std::size_t k) {
  const Spoke &from = spokes_[k], &to = after(k);
  Sector& sector = sectors_[k];
  sector.limit = kAnyAngle;
  if (sector.piece == kNone || count_ == 1 || (!from.separates && !to.separates)) return;
  const bool merged = !(from.start == to.start);
  sector.limit = merged ? limit_ : Angle(difference(from.end, from.start), difference(to.end, to.start)).limit(limit_);
}

bool Star::allows(const Point& p, const Room& room) {
  if (!keeps_lengths(p, room.length)) return false;
  for (std::size_t k = 0; k < count_ && !has_limits_; ++k) {
    set_limits(spokes_[k]);
    set_limit(k);
  }
  has_limits_ = true;
  if (!keeps_angles(p)) return false;
  const double reach = set_rooms(p, room.clearance);
  for (std::size_t k = 0; k < count_; ++k)
    if (sectors_[k].piece != kNone && !stays_clear(k, p, room.clearance, reach)) return false;
  return true;
}

/// Whether no wall becomes too short, or turns by more than 90 degrees.
bool Star::keeps_lengths(const Point& p, double least) const {
  return std::ranges::all_of(spokes(), [&](const Spoke& s) {
    const Point after = difference(s.end, p), before = difference(s.end, s.start);
    return dot(after, before) > 0 && dot(after, after) >= std::min(dot(before, before), least * least);
  });
}

bool Star::keeps_angles(const Point& p) const {
  for (std::size_t k = 0; k < count_; ++k) {
    const Spoke& s = spokes_[k];
    if (!Angle(difference(s.end, p), difference(after(k).end, p)).is_within(sectors_[k].limit)) return false;
    const Point home = difference(p, s.end);
    if (!Angle(difference(s.left, s.end), home).is_within(s.left_limit)) return false;
    if (!Angle(home, difference(s.right, s.end)).is_within(s.right_limit)) return false;
  }
  return true;
}

/// Returns the largest height of a room, at least `keep`.
double Star::set_rooms(const Point& p, double keep) {
  double reach = keep;
  for (std::size_t k = 0; k < count_; ++k) {
    if (!spokes_[k].separates) continue;
    rooms_[k] = SeparatorRoom(p, spokes_[k].end, keep);
    reach = std::max(reach, rooms_[k].height());
  }
  return reach;
}

/// Whether wall uw neither crosses spoke k, with the center at p, nor reaches into its room.
bool Star::leaves_room(std::size_t k, const Point& p, const Point& u, const Point& w) const {
  const Point& n = spokes_[k].end;
  if (u == n || w == n) return w != n || !rooms_[k].contains(u);
  return !crosses(p, n, u, w) && !rooms_[k].contains(u) && !rooms_[k].is_entered_by(u, w);
}

/// Whether the walls at the center keep away from the other corners and walls of sector k's piece. Most of these are
/// beyond the line from one spoke's end to the next, which is a quick test.
bool Star::stays_clear(std::size_t k, const Point& p, double keep, double reach) const {
  const Spoke &from = spokes_[k], &to = after(k);
  const Point& a = from.end;
  const Point d = difference(to.end, a);
  const double margin = reach * std::sqrt(dot(d, d));
  const bool before_line = cross(d, difference(from.start, a)) >= 0 && cross(d, difference(to.start, a)) >= 0 &&
                           cross(d, difference(p, a)) >= margin;
  const auto is_beyond = [&](const Point& c) { return before_line && cross(d, difference(c, a)) <= -margin; };
  Point u = a;
  bool u_beyond = before_line;
  const SideId home = PlanarMap::twin(to.side);
  for (SideId h = map_.side(from.side).next; h != home; h = map_.side(h).next) {
    const Point w = relative(map_.end(h));
    const bool last = map_.side(h).next == home, w_beyond = last ? before_line : is_beyond(w);
    if (!u_beyond || !w_beyond) {
      if (is_beside(p, u, w, keep)) return false;
      for (std::size_t i = 0; i < count_; ++i)
        if (spokes_[i].separates && !leaves_room(i, p, u, w)) return false;
    }
    u = w;
    u_beyond = w_beyond;
  }
  return true;
}

}  // namespace driftmesh
