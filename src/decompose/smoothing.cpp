#include "decompose/smoothing.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "decompose/star.hpp"
#include "decompose/star_cost.hpp"
#include "geometry/triangle_geometry.hpp"

namespace driftmesh {
namespace {

// Lengths are in units of a subdomain's size.
constexpr double kInterfaceWorth = 0.225;  ///< the cost at which an interface is removed
constexpr double kShort = 0.7;             ///< separators shorter than this may become points
constexpr double kClearance = 0.02;        ///< room between a separator and what it does not meet
constexpr double kLength = 0.1;            ///< least length of separators
constexpr double kLittle = 0.02;           ///< steps shorter than this are not worth their time

class Smoother {
 public:
  Smoother(PlanarMap& map, IdVector<PieceId, Piece>& pieces, const IdVector<PieceId, SubdomainId>& group_of,
           std::int32_t subdomains, double angle)
      : map_(map),
        pieces_(pieces),
        piece_of_(label_sides(map, pieces)),
        loads_(pieces, group_of, subdomains),
        star_(map, piece_of_, angle),
        cost_(star_, pieces, piece_of_) {}

  /// Ends move before any are merged, so that it shows which separators are short, and what a merger costs.
  void run() {
    move_ends(1);
    merge_ends();
    move_ends(2);
  }

 private:
  [[nodiscard]] bool is_separator(SideId h) const {
    return map_.wall(h).kind != PlanarMap::Kind::kInput && map_.side(h).in_domain();
  }
  [[nodiscard]] SubdomainId subdomain_left(SideId h) const { return loads_.group_of[piece_of_[h]]; }
  [[nodiscard]] bool is_interface(SideId h) const {
    return is_separator(h) && subdomain_left(h) != subdomain_left(PlanarMap::twin(h));
  }
  [[nodiscard]] double length(SideId h) const {
    return std::sqrt(squared_distance(map_.at(map_.start(h)), map_.at(map_.end(h))));
  }
  [[nodiscard]] bool allows(const Point& p) {
    return star_.allows(p, {kClearance * cost_.size(), kLength * cost_.size()});
  }

  /// Contracts separators where that is worth it, the shortest first. Loads may become larger than otherwise; moves
  /// that follow see to that.
  void merge_ends() {
    std::vector<std::pair<double, SideId>> shortest;
    for (const WallId w : ids_of(map_.walls)) {
      const SideId h = PlanarMap::first_side(w);
      if (!is_interface(h)) continue;
      const double relative = length(h) / loads_.size[subdomain_left(h)];
      if (relative < kShort) shortest.emplace_back(relative, h);
    }
    std::sort(shortest.begin(), shortest.end());
    for (const auto& [relative, h] : shortest)
      if (is_separator(h) && !merge(h)) (void)merge(PlanarMap::twin(h));
  }

  /// Contracts `side` to the point where it starts if only separators meet where it ends.
  bool merge(SideId side) {
    if (!roams(PlanarMap::twin(side)) || !star_.read_without(side)) return false;
    cost_.set(loads_, StarCost::kMostMerged);
    const std::optional<Point> place =
        place_merged(side, cost_.at_present() + length(side) + kInterfaceWorth * cost_.size());
    if (!place) return false;
    for (const SideId s : {side, PlanarMap::twin(side)}) {
      Piece& piece = pieces_[piece_of_[s]];
      if (piece.side == s) piece.side = map_.side(s).next;
    }
    const MapVertexId center = map_.start(side);
    map_.contract(side);
    settle(center, *place);
    return true;
  }

  [[nodiscard]] bool roams(SideId side) const {
    if (map_.origin[map_.start(side)] != kNone) return false;
    SideId h = side;
    do {
      if (!is_separator(h)) return false;
      h = PlanarMap::twin(map_.side(h).previous);
    } while (h != side);
    return true;
  }

  /// A place for what was `side`: the best one found that costs less than `most`.
  std::optional<Point> place_merged(SideId side, double most) {
    constexpr int kSteps = 3;
    const Point &a = map_.at(map_.start(side)), &b = map_.at(map_.end(side));
    Point p{0, 0};
    if (star_.freedom() == Star::Freedom::kRoams) p = {(b.x - a.x) / 2, (b.y - a.y) / 2};
    std::optional<Point> best;
    for (int k = 0; k < kSteps; ++k) {
      const double cost = cost_.at(p);
      if (cost < most && allows(p)) {
        best = p;
        most = cost;
      }
      if (star_.freedom() == Star::Freedom::kStays) break;
      const Point step = cost_.step(p);
      p = {p.x + step.x, p.y + step.y};
    }
    return best;
  }

  /// For each point where interfaces meet that is not the input's, a side that starts there.
  [[nodiscard]] IdVector<MapVertexId, SideId> movable_ends() const {
    IdVector<MapVertexId, SideId> sides(map_.points.size(), kNone);
    for (const SideId h : ids_of(map_.sides))
      if (is_interface(h) && map_.origin[map_.start(h)] == kNone) sides[map_.start(h)] = h;
    return sides;
  }

  void move_ends(int rounds) {
    const IdVector<MapVertexId, SideId> sides = movable_ends();
    for (int round = 0; round < rounds; ++round)
      for (const SideId side : sides)
        if (side != kNone) move(side);
  }

  /// Moves the point where `side` starts to a place that costs less.
  void move(SideId side) {
    if (!star_.read(side) || star_.freedom() == Star::Freedom::kStays) return;
    cost_.set(loads_, StarCost::kMostMoved);
    const double present = cost_.at({0, 0});
    const Point whole = cost_.step({0, 0});
    const double least = kLittle * cost_.size();
    for (double part = 1; part > 0.2; part /= 2) {
      const Point p{part * whole.x, part * whole.y};
      if (p.x * p.x + p.y * p.y < least * least) return;
      if (cost_.at(p) >= present || !allows(p)) continue;
      settle(map_.start(side), p);
      return;
    }
  }

  void settle(MapVertexId center, const Point& p) {
    cost_.move(p, pieces_, loads_);
    map_.points[center] = {snap_to_zero(star_.origin().x + p.x), snap_to_zero(star_.origin().y + p.y)};
  }

  PlanarMap& map_;
  IdVector<PieceId, Piece>& pieces_;
  IdVector<SideId, PieceId> piece_of_;
  Loads loads_;
  Star star_;
  StarCost cost_;
};

}  // namespace

void smooth(PlanarMap& map, IdVector<PieceId, Piece>& pieces, const IdVector<PieceId, SubdomainId>& group_of,
            std::int32_t subdomains, double angle) {
  Smoother(map, pieces, group_of, subdomains, angle).run();
}

}  // namespace driftmesh
