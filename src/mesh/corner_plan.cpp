#include "mesh/corner_plan.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <utility>

#include "base/disjoint_sets.hpp"
#include "geometry/triangle_geometry.hpp"

namespace driftmesh {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kOpen = 2 * std::numbers::pi;  // stands for all sectors of 180 degrees or more
constexpr double kAcute = 60 * kDegree * (1 - 1e-12);
constexpr double kOutsideLenses = 30 * kDegree * (1 - 1e-12);
constexpr double kSharp = 20 * kDegree;
/// In radians. Between neighbors that diverge more slowly, pieces that do not line up cost more triangles (about 2.1 /
/// angle) than an additional cut.
constexpr double kBundled = 0.01;

/// Ends of segments share a circle if their distances from the apex differ by at most this fraction of the width
/// between them.
constexpr double kSameCircle = 0.25;
/// The same relative to the distance, for segments of one length: the check looks for distances within a thousandth.
constexpr double kSameLength = 0.0005;

/// The segment ends of a triangulation with the sectors between them.
class Sectors {
 public:
  Sectors(const Triangulation& mesh, const IdVector<RootId, bool>& fixed) : mesh_(mesh), fixed_(fixed) {
    const std::size_t ends = 2 * mesh.roots.size();
    next_.reserve(ends);
    angle_.reserve(ends);
    length_.reserve(ends);
    for (const SegmentEnd e : first_ids<SegmentEnd>(ends)) {
      const auto& v = mesh.roots[root_of(e)].vertex;
      length_.push_back(std::sqrt(squared_distance(mesh.points[v[0]], mesh.points[v[1]])));
      next_.push_back(next_around_apex(e));
      const bool forms_none = next_.back() == kNone || next_.back() == e || is_fixed(e) || is_fixed(next_.back());
      angle_.push_back(forms_none ? kOpen : angle_between(e, next_.back()));
      smallest_angle_ = std::min(smallest_angle_, angle_.back());
    }
  }

  [[nodiscard]] IdRange<SegmentEnd> ends() const { return ids_of(next_); }
  [[nodiscard]] std::size_t count() const { return next_.size(); }
  /// The end that follows `e` counterclockwise around its apex inside the domain; kNone if e's left is outside.
  [[nodiscard]] SegmentEnd next(SegmentEnd e) const { return next_[e]; }
  /// The angle to it in radians.
  [[nodiscard]] double angle(SegmentEnd e) const { return angle_[e]; }
  [[nodiscard]] double smallest_angle() const { return smallest_angle_; }
  [[nodiscard]] double length(SegmentEnd e) const { return length_[e]; }
  [[nodiscard]] const Point& apex(SegmentEnd e) const { return mesh_.points[apex_vertex(e)]; }
  [[nodiscard]] const Point& tip(SegmentEnd e) const { return apex(other_end(e)); }

 private:
  [[nodiscard]] VertexId apex_vertex(SegmentEnd e) const { return mesh_.roots[root_of(e)].vertex[side_of(e)]; }

  [[nodiscard]] bool is_fixed(SegmentEnd e) const { return !fixed_.empty() && fixed_[root_of(e)]; }

  [[nodiscard]] SegmentEnd next_around_apex(SegmentEnd e) const {
    const Subsegment& s = mesh_.subsegments[mesh_.roots[root_of(e)].tree];
    HalfEdge h = s.half[side_of(e)];  // the edge that leaves the apex, with the domain on its left
    if (h == kNone) return kNone;
    do {
      h = mesh_.twin(half_edge(triangle_of(h), previous(index_of(h))));  // across the triangle's edge into the apex
    } while (!is_constrained(h));
    const Subsegment& last = mesh_.subsegments[subsegment_of(h)];
    return segment_end(last.root, last.vertex[0] == apex_vertex(e) ? 0 : 1);
  }

  [[nodiscard]] double angle_between(SegmentEnd e, SegmentEnd f) const {
    if (!(orient2d(apex(e), tip(e), tip(f)) > 0)) return kOpen;
    return angle_at(tip(e), apex(e), tip(f));
  }

  const Triangulation& mesh_;
  const IdVector<RootId, bool>& fixed_;
  IdVector<SegmentEnd, SegmentEnd> next_;
  IdVector<SegmentEnd, double> angle_;
  IdVector<SegmentEnd, double> length_;
  double smallest_angle_ = kOpen;
};

/// The angle from which on segments that meet need no protection for an angle bound in degrees, see prepare_corners.
double protected_below(double min_angle) {
  return std::max(kOutsideLenses, std::asin(2 / std::numbers::sqrt3 * std::sin(min_angle * kDegree)));
}

/// Segment ends at one apex that are joined by sectors below some angle.
struct Group {
  std::vector<SegmentEnd> ends;
  double smallest_angle = kOpen;
};

std::vector<Group> groups_below(const Sectors& sectors, double angle) {
  if (sectors.smallest_angle() >= angle) return {};
  DisjointSets<SegmentEnd> sets(sectors.count());
  IdVector<SegmentEnd, double> smallest(sectors.count(), kOpen);
  for (const SegmentEnd e : sectors.ends()) {
    if (sectors.angle(e) >= angle) continue;
    const SegmentEnd f = sectors.next(e);
    sets.join(e, f);
    smallest[e] = std::min(smallest[e], sectors.angle(e));
    smallest[f] = std::min(smallest[f], sectors.angle(e));
  }
  std::map<SegmentEnd, Group> groups;  // by their sets: most ends are in none
  for (const SegmentEnd e : sectors.ends()) {
    if (smallest[e] == kOpen) continue;
    Group& group = groups[sets.find(e)];
    group.ends.push_back(e);
    group.smallest_angle = std::min(group.smallest_angle, smallest[e]);
  }
  std::vector<Group> in_order;
  for (auto& [set, group] : groups) in_order.push_back(std::move(group));
  return in_order;
}

/// Chooses circles around each apex, and turns them into cuts. The circles of a segment between two acute corners end
/// in its first third, except where shorter neighbors end farther away (see grant_wishes).
class Planner {
 public:
  Planner(const Sectors& sectors, const CornerUse& use)
      : sectors_(sectors),
        use_(use),
        tip_circle_(sectors.count(), kNone),
        apex_(sectors.count(), kNone),
        whole_(sectors.count(), false) {}

  CornerPlan plan() {
    const std::vector<Group> clusters =
        groups_below(sectors_, use_.rules.conforming ? kAcute : protected_below(use_.min_angle));
    for (const Group& cluster : clusters) {
      const std::int32_t apex = names_++;
      for (const SegmentEnd e : cluster.ends) apex_[e] = apex;
    }
    for (const Group& cluster : clusters)
      if (!leave_whole(cluster)) {
        add_powers(cluster);
        name_tips(cluster);
      }
    for (const Group& bundle : groups_below(sectors_, kBundled))
      if (!whole_[bundle.ends.front()]) add_tips(bundle);
    for (const RootId root : roots_with_wishes()) grant_wishes(segment_end(root, 0), segment_end(root, 1));
    for (auto& [e, circles] : circles_) cut(e, circles);
    return std::move(plan_);
  }

 private:
  struct Circle {
    double radius;
    std::int32_t name;    // shared by all that are cut at it
    std::int32_t vertex;  // name of the new vertex
    double width = 0;     // width of the narrowest sector there
  };

  [[nodiscard]] bool clustered(SegmentEnd e) const { return apex_[e] != kNone; }

  /// Segments of one length need no cuts: their midpoints are on common circles anyway. Not where a segment ends in
  /// another acute corner, from which its halves would have to be counted as well.
  bool leave_whole(const Group& cluster) {
    if (use_.decomposed) return false;
    double shortest = std::numeric_limits<double>::infinity(), longest = 0;
    for (const SegmentEnd e : cluster.ends) {
      if (clustered(other_end(e))) return false;
      shortest = std::min(shortest, sectors_.length(e));
      longest = std::max(longest, sectors_.length(e));
    }
    if (longest > shortest * (1 + same_length(cluster))) return false;
    const std::int32_t tips = names_++;
    for (const SegmentEnd e : cluster.ends) {
      whole_[e] = true;
      plan_.tips.push_back({e, shell_between(apex_[e], tips)});
    }
    return true;
  }

  /// Powers of two: the largest one that all segments reach and, in a sharp cluster, all larger ones, as far as each
  /// segment reaches.
  void add_powers(const Group& cluster) {
    double shortest = std::numeric_limits<double>::infinity();
    for (const SegmentEnd e : cluster.ends)
      shortest = std::min(shortest, use_.decomposed ? sectors_.length(e) / 3 : reach(e));
    const bool sharp = cluster.smallest_angle < kSharp;
    double radius = std::exp2(std::floor(std::log2(shortest)));
    for (bool any = true; any; radius *= 2) {
      any = false;
      const std::int32_t name = names_++;
      for (const SegmentEnd e : cluster.ends) {
        if (radius > reach(e)) {
          if (sharp && clustered(other_end(e))) spare_[e].push_back({radius, name, name});
          continue;
        }
        circles_[e].push_back({radius, name, sharp ? name : names_++});
        any = sharp;
      }
    }
  }

  /// How far from its apex a segment may be cut: a cluster at the other end has the same right.
  [[nodiscard]] double reach(SegmentEnd e) const {
    return sectors_.length(e) * (clustered(other_end(e)) ? 1.0 / 3 : 2.0 / 3);
  }

  /// By which fraction lengths may differ that count as one.
  static double same_length(const Group& cluster) {
    return std::min(kSameLength, kSameCircle * cluster.smallest_angle);
  }

  /// Ends of segments of one length lie on a circle, so that the outermost pieces are cut on common circles as well.
  void name_tips(const Group& cluster) {
    if (use_.decomposed) return;
    const std::vector<SegmentEnd> ends = by_length(cluster);
    for (auto first = ends.begin(); first != ends.end();) {
      const std::int32_t name = names_++;
      const double most = sectors_.length(*first) * (1 + same_length(cluster));
      for (; first != ends.end() && sectors_.length(*first) <= most; ++first)
        if (!clustered(other_end(*first))) tip_circle_[*first] = name;
    }
  }

  [[nodiscard]] std::vector<SegmentEnd> by_length(const Group& group) const {
    std::vector<SegmentEnd> ends = group.ends;
    std::sort(ends.begin(), ends.end(), [&](SegmentEnd e, SegmentEnd f) {
      return std::pair(sectors_.length(e), e) < std::pair(sectors_.length(f), f);
    });
    return ends;
  }

  /// In a bundle of nearly parallel segments, the longer ones are cut where the shorter ones end.
  void add_tips(const Group& bundle) {
    const std::vector<SegmentEnd> ends = by_length(bundle);
    for (std::size_t i = 0; i < ends.size();) {
      const double radius = sectors_.length(ends[i]);
      const std::int32_t name = names_++;
      for (; i < ends.size() && sectors_.length(ends[i]) <= radius * (1 + kSameCircle * bundle.smallest_angle); ++i) {
        if (!clustered(other_end(ends[i]))) tip_circle_[ends[i]] = name;
        drop_powers_near(ends[i], radius);
      }
      for (std::size_t k = i; k < ends.size(); ++k) {
        drop_powers_near(ends[k], radius);
        const Circle circle{radius, name, name, radius * bundle.smallest_angle};
        (clustered(other_end(ends[k])) ? wishes_ : circles_)[ends[k]].push_back(circle);
      }
    }
  }

  [[nodiscard]] std::vector<RootId> roots_with_wishes() const {
    std::vector<RootId> roots;
    for (const auto& [e, circles] : wishes_)
      if (roots.empty() || roots.back() != root_of(e)) roots.push_back(root_of(e));
    return roots;
  }

  /// A segment between two acute corners is also cut where shorter neighbors end beyond its first third, as far as the
  /// cuts from both ends leave each other room.
  void grant_wishes(SegmentEnd e, SegmentEnd f) {
    std::vector<Circle>&from_e = wishes_[e], &from_f = wishes_[f];
    while (!from_e.empty() && !from_f.empty()) {
      const Circle &r = from_e.back(), &s = from_f.back();
      const double gap = sectors_.length(e) - r.radius - s.radius;
      if (std::fabs(gap) <= kSameCircle * std::min(r.width, s.width)) return cut_at_common_place(e, f);
      if (gap > 0) break;
      (r.radius > s.radius ? from_e : from_f).pop_back();
    }
    grant(e, f);
    grant(f, e);
  }

  /// Where neighbors of both corners end at one place, as the other two sides of a sliver do, one cut serves both. Each
  /// corner cuts up to there.
  void cut_at_common_place(SegmentEnd e, SegmentEnd f) {
    tip_circle_[f] = wishes_[f].back().name;
    for (const SegmentEnd end : {e, f}) {
      const double place = wishes_[end].back().radius;
      std::erase_if(circles_[end], [&](const Circle& c) { return c.radius > place; });
      add_spare_powers(end, place);
      if (end == f) wishes_[end].pop_back();
      circles_[end].insert(circles_[end].end(), wishes_[end].begin(), wishes_[end].end());
    }
  }

  /// Cuts at the powers of two up to a wish as well, like the neighbor that ends there.
  void add_spare_powers(SegmentEnd e, double most) {
    for (const Circle& power : spare_[e]) {
      const auto near = [&](const Circle& wish) {
        return power.radius > 2.0 / 3 * wish.radius && power.radius < 4.0 / 3 * wish.radius;
      };
      if (power.radius < most && std::ranges::none_of(wishes_[e], near)) circles_[e].push_back(power);
    }
    spare_[e].clear();
  }

  /// Cuts at the wishes of `e`: those in its first third, and farther ones that come off well from the cuts of the
  /// other end, which gives up those that are too near, but not its last.
  void grant(SegmentEnd e, SegmentEnd f) {
    std::vector<Circle>& others = circles_[f];
    std::vector<Circle>& wishes = wishes_[e];
    const auto first_third = [&](const Circle& wish) { return wish.radius < sectors_.length(e) / 3; };
    while (!wishes.empty() && !first_third(wishes.back())) {
      const double most = 2.0 / 3 * (sectors_.length(e) - wishes.back().radius);
      const auto too_near = [&](const Circle& c) { return c.radius > most; };
      if (others.empty() || !std::ranges::all_of(others, too_near)) {
        std::erase_if(others, too_near);
        add_spare_powers(e, wishes.back().radius);
        break;
      }
      wishes.pop_back();
    }
    circles_[e].insert(circles_[e].end(), wishes.begin(), wishes.end());
  }

  void drop_powers_near(SegmentEnd e, double radius) {
    const auto found = circles_.find(e);
    if (found == circles_.end()) return;
    std::erase_if(found->second, [&](const Circle& c) {
      return c.radius > 2.0 / 3 * radius && c.radius < 4.0 / 3 * radius &&
             std::exp2(std::floor(std::log2(c.radius))) == c.radius;
    });
  }

  void cut(SegmentEnd e, std::vector<Circle>& circles) {
    std::sort(circles.begin(), circles.end(), [](const Circle& a, const Circle& b) { return a.radius < b.radius; });
    std::int32_t inner = apex_[e];
    const Point &a = sectors_.apex(e), &b = sectors_.tip(e);
    for (const Circle& c : circles) {
      const double share = c.radius / sectors_.length(e);
      const Point at{snap_to_zero(a.x + share * (b.x - a.x)), snap_to_zero(a.y + share * (b.y - a.y))};
      plan_.cuts.push_back({e, at, shell_between(inner, c.name), c.vertex});
      inner = c.name;
    }
    if (tip_circle_[e] != kNone && !circles.empty()) plan_.tips.push_back({e, shell_between(inner, tip_circle_[e])});
  }

  std::int32_t shell_between(std::int32_t inner, std::int32_t outer) {
    return shells_.try_emplace({inner, outer}, static_cast<std::int32_t>(shells_.size())).first->second;
  }

  const Sectors& sectors_;
  CornerUse use_;
  std::map<SegmentEnd, std::vector<Circle>> circles_;  // for ends that are cut
  std::map<SegmentEnd, std::vector<Circle>> wishes_;   // for ends in a bundle, nearest first, not yet granted
  std::map<SegmentEnd, std::vector<Circle>> spare_;    // powers of two beyond the reach of an end
  IdVector<SegmentEnd, std::int32_t> tip_circle_;      // for each end, the circle that the other end lies on
  IdVector<SegmentEnd, std::int32_t> apex_;  // for each end, the name of its cluster's apex, kNone if it is in none
  IdVector<SegmentEnd, bool> whole_;         // for each end, whether its cluster needs no cuts
  std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> shells_;
  std::int32_t names_ = 0;
  CornerPlan plan_;
};

}  // namespace

CornerPlan plan_corners(const Triangulation& mesh, const CornerUse& use, const IdVector<RootId, bool>& fixed) {
  const Sectors sectors(mesh, fixed);
  const auto acute = static_cast<std::int32_t>(groups_below(sectors, kAcute).size());
  if (acute == 0) return {};  // clusters are groups of acute sectors
  CornerPlan plan = Planner(sectors, use).plan();
  plan.clusters = acute;
  return plan;
}

}  // namespace driftmesh
