#include "decompose/fork.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include "decompose/separator_room.hpp"
#include "geometry/predicates.hpp"
#include "geometry/triangle_geometry.hpp"

namespace driftmesh {
namespace {

/// The worth of even parts, in units of the square root of the piece's area.
constexpr double kEven = 2;
/// To keep between a separator and other corners, in units of the spacing of stations.
constexpr double kCornerClearance = 0.2;

Point centroid(const Loop& loop) {
  const Point o = loop.front().at;
  double twice_area = 0, x = 0, y = 0;
  for (std::size_t k = 1; k + 1 < loop.size(); ++k) {
    const Point a{loop[k].at.x - o.x, loop[k].at.y - o.y}, b{loop[k + 1].at.x - o.x, loop[k + 1].at.y - o.y};
    const double swept = a.x * b.y - a.y * b.x;
    twice_area += swept;
    x += swept * (a.x + b.x) / 3;
    y += swept * (a.y + b.y) / 3;
  }
  return {o.x + x / twice_area, o.y + y / twice_area};
}

bool sees_all(const Point& p, const Loop& loop) {
  for (std::size_t k = 0; k < loop.size(); ++k)
    if (orient2d(p, loop[k].at, loop[k + 1 < loop.size() ? k + 1 : 0].at) <= 0) return false;
  return true;
}

/// A place on the border where a separator from the center may end.
struct End {
  std::size_t station;
  Point direction;  ///< unit vector from the center
  double distance;
  double swept;  ///< the fraction of the area before it
};

class Search {
 public:
  Search(const Outline& outline, const Point& center, double angle)
      : outline_(outline), center_(center), cosine_(std::cos(angle)), size_(std::sqrt(outline.area)) {
    const auto& stations = outline.stations;
    double twice_swept = 0;
    for (std::size_t i = 0; i < stations.size(); ++i) {
      if (may_end_at(stations[i])) ends_.push_back(end_at(i, twice_swept / (2 * outline.area)));
      twice_swept += twice_area(stations[i].at, stations[i + 1 < stations.size() ? i + 1 : 0].at);
    }
  }

  std::optional<Fork> run() {
    for (std::size_t i = 0; i < ends_.size(); ++i)
      for (std::size_t j = i + 1; j < ends_.size(); ++j) {
        if (!may_follow(ends_[i], ends_[j])) continue;
        for (std::size_t k = j + 1; k < ends_.size(); ++k) consider(ends_[i], ends_[j], ends_[k]);
      }
    return best_;
  }

 private:
  [[nodiscard]] double twice_area(const Point& a, const Point& b) const {
    return (a.x - center_.x) * (b.y - center_.y) - (a.y - center_.y) * (b.x - center_.x);
  }
  [[nodiscard]] End end_at(std::size_t station, double swept) const {
    const Point& p = outline_.stations[station].at;
    const double distance = std::sqrt(squared_distance(p, center_));
    return {station, {(p.x - center_.x) / distance, (p.y - center_.y) / distance}, distance, swept};
  }
  [[nodiscard]] bool may_end_at(const Outline::Station& s) const {
    const double dx = center_.x - s.at.x, dy = center_.y - s.at.y;
    return s.usable && Outline::allows(s, dx, dy) && has_room(s);
  }
  /// Whether a separator from `s` to the center has room.
  [[nodiscard]] bool has_room(const Outline::Station& s) const {
    const SeparatorRoom room(s.at, center_, kCornerClearance * outline_.spacing);
    const Loop& loop = outline_.loop;
    for (std::size_t k = 0; k < loop.size(); ++k) {
      const Point &u = loop[k].at, &v = loop[k + 1 < loop.size() ? k + 1 : 0].at;
      if (!(u == s.at) && room.contains(u)) return false;
      const bool meets = u == s.at || v == s.at || (!s.corner && loop[k].side == s.side);
      if (!meets && room.is_entered_by(u, v)) return false;
    }
    return true;
  }
  [[nodiscard]] bool may_follow(const End& a, const End& b) const {
    const bool narrow = a.direction.x * b.direction.y - a.direction.y * b.direction.x >= 0 &&
                        a.direction.x * b.direction.x + a.direction.y * b.direction.y > cosine_;
    return !narrow && PlanarMap::wall_of(outline_.stations[a.station].side) !=
                          PlanarMap::wall_of(outline_.stations[b.station].side);
  }
  void consider(const End& a, const End& b, const End& c) {
    if (!may_follow(b, c) || !may_follow(c, a)) return;
    const double shares[] = {b.swept - a.swept, c.swept - b.swept, 1 - (c.swept - a.swept)};
    double cost = (a.distance + b.distance + c.distance) / size_;
    for (const double share : shares) cost += kEven * (3 * share - 1) * (3 * share - 1);
    if (cost >= least_) return;
    least_ = cost;
    const auto& stations = outline_.stations;
    best_ = Fork{center_, {stations[a.station], stations[b.station], stations[c.station]}};
  }

  const Outline& outline_;
  Point center_;
  double cosine_, size_;
  std::vector<End> ends_;
  double least_ = std::numeric_limits<double>::infinity();
  std::optional<Fork> best_;
};

}  // namespace

std::optional<Fork> find_fork(const Outline& outline, double angle) {
  const Point center = centroid(outline.loop);
  if (!sees_all(center, outline.loop)) return std::nullopt;
  return Search(outline, center, angle).run();
}

}  // namespace driftmesh
