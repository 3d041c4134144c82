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

constexpr auto id = &Triangulation::id;
constexpr double kDegree = std::numbers::pi / 180;
constexpr double kOpen = 2 * std::numbers::pi;  // stands for all sectors of 180 degrees or more
constexpr double kAcute = 60 * kDegree * (1 - 1e-12);
constexpr double kSharp = 20 * kDegree;
/// In radians. Between neighbors that diverge more slowly, pieces that do not line up cost more triangles (about
/// 2.1 / angle) than another cut does.
constexpr double kBundled = 0.01;

/// Ends of segments share a circle if their distances from the apex differ by at most this share of the width between
/// them.
constexpr double kSameCircle = 0.25;

/// The segment ends of a triangulation with the sectors between them.
class Sectors {
 public:
  explicit Sectors(const Triangulation& mesh) : mesh_(mesh) {
    for (std::size_t i = 0; i < 2 * mesh.roots.size(); ++i) {
      const auto e = static_cast<SegmentEnd>(i);
      const auto& v = mesh.roots[id(root_of(e))].vertex;
      length_.push_back(std::sqrt(squared_distance(mesh.points[id(v[0])], mesh.points[id(v[1])])));
      next_.push_back(next_around_apex(e));
      angle_.push_back(next_.back() == kNone || next_.back() == e ? kOpen : angle_between(e, next_.back()));
    }
  }

  [[nodiscard]] std::size_t count() const { return next_.size(); }
  /// The end that follows `e` counterclockwise around its apex inside the domain; kNone if e's left is outside.
  [[nodiscard]] SegmentEnd next(SegmentEnd e) const { return next_[id(e)]; }
  /// The angle to it in radians.
  [[nodiscard]] double angle(SegmentEnd e) const { return angle_[id(e)]; }
  [[nodiscard]] double length(SegmentEnd e) const { return length_[id(e)]; }
  [[nodiscard]] const Point& apex(SegmentEnd e) const { return mesh_.points[id(apex_vertex(e))]; }
  [[nodiscard]] const Point& tip(SegmentEnd e) const { return apex(e ^ 1); }

 private:
  [[nodiscard]] VertexId apex_vertex(SegmentEnd e) const { return mesh_.roots[id(root_of(e))].vertex[id(e % 2)]; }

  [[nodiscard]] SegmentEnd next_around_apex(SegmentEnd e) const {
    const Subsegment& s = mesh_.subsegments[id(mesh_.roots[id(root_of(e))].tree)];
    HalfEdge h = s.half[id(e % 2)];  // the edge that leaves the apex, with the domain on its left
    if (h == kNone) return kNone;
    do {
      h = mesh_.twin(half_edge(triangle_of(h), previous(index_of(h))));  // across the triangle's edge into the apex
    } while (!is_constrained(h));
    const Subsegment& last = mesh_.subsegments[id(subsegment_of(h))];
    return 2 * last.root + (last.vertex[0] == apex_vertex(e) ? 0 : 1);
  }

  [[nodiscard]] double angle_between(SegmentEnd e, SegmentEnd f) const {
    if (!(orient2d(apex(e), tip(e), tip(f)) > 0)) return kOpen;
    return angle_at(tip(e), apex(e), tip(f));
  }

  const Triangulation& mesh_;
  std::vector<SegmentEnd> next_;
  std::vector<double> angle_;
  std::vector<double> length_;
};

/// Segment ends at one apex that are joined by sectors below some angle.
struct Group {
  std::vector<SegmentEnd> ends;
  double smallest_angle = kOpen;
};

std::vector<Group> groups_below(const Sectors& sectors, double angle) {
  DisjointSets sets(sectors.count());
  std::vector<double> smallest(sectors.count(), kOpen);
  for (std::size_t i = 0; i < sectors.count(); ++i) {
    const auto e = static_cast<SegmentEnd>(i);
    if (sectors.angle(e) >= angle) continue;
    const SegmentEnd f = sectors.next(e);
    sets.join(e, f);
    smallest[i] = std::min(smallest[i], sectors.angle(e));
    smallest[id(f)] = std::min(smallest[id(f)], sectors.angle(e));
  }
  std::vector<Group> groups(sectors.count());
  for (std::size_t i = 0; i < sectors.count(); ++i) {
    if (smallest[i] == kOpen) continue;
    Group& group = groups[id(sets.find(static_cast<SegmentEnd>(i)))];
    group.ends.push_back(static_cast<SegmentEnd>(i));
    group.smallest_angle = std::min(group.smallest_angle, smallest[i]);
  }
  std::erase_if(groups, [](const Group& g) { return g.ends.empty(); });
  return groups;
}

/// Chooses circles around each apex, and turns them into cuts.
class Planner {
 public:
  explicit Planner(const Sectors& sectors)
      : sectors_(sectors),
        circles_(sectors.count()),
        tip_circle_(sectors.count(), kNone),
        apex_(sectors.count(), kNone) {}

  CornerPlan plan() {
    const std::vector<Group> clusters = groups_below(sectors_, kAcute);
    for (const Group& cluster : clusters) {
      const std::int32_t apex = names_++;
      for (const SegmentEnd e : cluster.ends) apex_[id(e)] = apex;
    }
    for (const Group& cluster : clusters) add_powers(cluster);
    for (const Group& bundle : groups_below(sectors_, kBundled)) add_tips(bundle);
    for (std::size_t i = 0; i < sectors_.count(); ++i) cut(static_cast<SegmentEnd>(i));
    plan_.clusters = static_cast<std::int32_t>(clusters.size());
    return std::move(plan_);
  }

 private:
  struct Circle {
    double radius;
    std::int32_t name;    // shared by all that are cut at it
    std::int32_t vertex;  // name of the new vertex
  };

  [[nodiscard]] bool clustered(SegmentEnd e) const { return apex_[id(e)] != kNone; }

  /// Powers of two: the largest that is at most a third of the shortest segment and, in a sharp cluster, all above, as
  /// far as each segment reaches.
  void add_powers(const Group& cluster) {
    double shortest = std::numeric_limits<double>::infinity();
    for (const SegmentEnd e : cluster.ends) shortest = std::min(shortest, sectors_.length(e));
    const bool sharp = cluster.smallest_angle < kSharp;
    double radius = std::exp2(std::floor(std::log2(shortest / 3)));
    for (bool any = true; any; radius *= 2) {
      any = false;
      const std::int32_t name = names_++;
      for (const SegmentEnd e : cluster.ends) {
        if (radius > sectors_.length(e) * (clustered(e ^ 1) ? 1.0 / 3 : 2.0 / 3)) continue;
        circles_[id(e)].push_back({radius, name, sharp ? name : names_++});
        any = sharp;
      }
    }
  }

  /// In a bundle of segments that hardly diverge, the longer ones are cut where the shorter ones end.
  void add_tips(const Group& bundle) {
    std::vector<SegmentEnd> by_length = bundle.ends;
    std::sort(by_length.begin(), by_length.end(), [&](SegmentEnd e, SegmentEnd f) {
      return std::pair(sectors_.length(e), e) < std::pair(sectors_.length(f), f);
    });
    for (std::size_t i = 0; i < by_length.size();) {
      const double radius = sectors_.length(by_length[i]);
      const std::int32_t name = names_++;
      for (;
           i < by_length.size() && sectors_.length(by_length[i]) <= radius * (1 + kSameCircle * bundle.smallest_angle);
           ++i) {
        if (!clustered(by_length[i] ^ 1)) tip_circle_[id(by_length[i])] = name;
        drop_powers_near(by_length[i], radius);
      }
      for (std::size_t k = i; k < by_length.size(); ++k) {
        drop_powers_near(by_length[k], radius);
        const double most = sectors_.length(by_length[k]) * (clustered(by_length[k] ^ 1) ? 1.0 / 3 : 1.0);
        if (radius < most) circles_[id(by_length[k])].push_back({radius, name, name});
      }
    }
  }

  void drop_powers_near(SegmentEnd e, double radius) {
    std::erase_if(circles_[id(e)], [&](const Circle& c) {
      return c.radius > 2.0 / 3 * radius && c.radius < 4.0 / 3 * radius &&
             std::exp2(std::floor(std::log2(c.radius))) == c.radius;
    });
  }

  void cut(SegmentEnd e) {
    std::vector<Circle>& circles = circles_[id(e)];
    std::sort(circles.begin(), circles.end(), [](const Circle& a, const Circle& b) { return a.radius < b.radius; });
    std::int32_t inner = apex_[id(e)];
    const Point &a = sectors_.apex(e), &b = sectors_.tip(e);
    for (const Circle& c : circles) {
      const double share = c.radius / sectors_.length(e);
      const Point at{snap_to_zero(a.x + share * (b.x - a.x)), snap_to_zero(a.y + share * (b.y - a.y))};
      plan_.cuts.push_back({e, at, shell_between(inner, c.name), c.vertex});
      inner = c.name;
    }
    if (tip_circle_[id(e)] != kNone && !circles.empty())
      plan_.tips.push_back({e, shell_between(inner, tip_circle_[id(e)])});
  }

  std::int32_t shell_between(std::int32_t inner, std::int32_t outer) {
    return shells_.try_emplace({inner, outer}, static_cast<std::int32_t>(shells_.size())).first->second;
  }

  const Sectors& sectors_;
  std::vector<std::vector<Circle>> circles_;  // of each end
  std::vector<std::int32_t> tip_circle_;      // of each end: the circle that the other end lies on
  std::vector<std::int32_t> apex_;            // of each end: the name of its cluster's apex, kNone if it is in none
  std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> shells_;
  std::int32_t names_ = 0;
  CornerPlan plan_;
};

}  // namespace

CornerPlan plan_corners(const Triangulation& mesh) {
  const Sectors sectors(mesh);
  return Planner(sectors).plan();
}

}  // namespace driftmesh
