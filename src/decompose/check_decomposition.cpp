#include "decompose/check_decomposition.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <span>
#include <utility>

#include "base/disjoint_sets.hpp"
#include "base/formatted.hpp"
#include "geometry/box_tree.hpp"
#include "geometry/predicates.hpp"
#include "geometry/triangle_geometry.hpp"

namespace driftmesh {
namespace {

/// A root seen from one of its ends: 2 * root from a, 2 * root + 1 from b.
using Dart = std::int32_t;
/// A loop of darts with a subdomain on its left.
using Border = std::int32_t;

class Checker {
 public:
  explicit Checker(const Decomposition& d) : d_(d), next_(2 * d.roots.size(), kNone) {}

  DecompositionReport run() {
    report_.angle_histogram.assign(18, 0);
    if (check_ranges()) {
      check_crossings();
      check_points();
      check_borders();
      check_lists();
      check_inner_points();
      measure();
    }
    return std::move(report_);
  }

 private:
  void problem(const std::string& what) {
    if (report_.problems.size() < DecompositionReport::kMaxProblems) report_.problems.push_back(what);
  }

  [[nodiscard]] static GlobalRootId root_of(Dart e) { return GlobalRootId{e / 2}; }
  [[nodiscard]] const Decomposition::Root& root(Dart e) const { return d_.roots[root_of(e)]; }
  [[nodiscard]] GlobalPointId start(Dart e) const { return e % 2 == 0 ? root(e).a : root(e).b; }
  [[nodiscard]] GlobalPointId end(Dart e) const { return start(e ^ 1); }
  [[nodiscard]] SubdomainId left(Dart e) const { return e % 2 == 0 ? root(e).left : root(e).right; }
  [[nodiscard]] std::uint16_t left_region(Dart e) const {
    return e % 2 == 0 ? root(e).left_region : root(e).right_region;
  }
  [[nodiscard]] const Point& point(GlobalPointId v) const { return d_.points[v]; }
  [[nodiscard]] std::string place(GlobalPointId v) const {
    return formatted("point {} ({}, {})", to_string(v), point(v).x, point(v).y);
  }

  bool check_ranges() {
    if (d_.origin.size() != d_.points.size())
      problem(std::to_string(d_.points.size()) + " points but " + std::to_string(d_.origin.size()) + " origins");
    for (const GlobalPointId v : ids_of(d_.points))
      if (!in_coordinate_range(d_.points[v].x) || !in_coordinate_range(d_.points[v].y))
        problem("point " + to_string(v) + " has a coordinate out of range");
    const auto is_subdomain = [&](SubdomainId s) { return s == kNoSubdomain || d_.subdomains.has(s); };
    for (const GlobalRootId r : ids_of(d_.roots)) {
      const Decomposition::Root& root = d_.roots[r];
      const auto name = [&] { return "root " + to_string(r) + " "; };
      if (!d_.points.has(root.a) || !d_.points.has(root.b) || root.a == root.b ||
          (root.a > root.b && root.shell == kNone))
        problem(name() + "joins points " + to_string(root.a) + " and " + to_string(root.b) + " of " +
                std::to_string(d_.points.size()));
      if (!is_subdomain(root.left) || !is_subdomain(root.right) ||
          (root.left == kNoSubdomain && root.right == kNoSubdomain))
        problem(name() + "lies between subdomains " + to_string(root.left) + " and " + to_string(root.right) + " of " +
                std::to_string(d_.size()));
      if (root.separator && !root.is_interface()) problem(name() + "is a separator without two subdomains");
    }
    return report_.problems.empty();
  }

  void check_crossings() {
    IdVector<GlobalRootId, Box> boxes;
    for (const Decomposition::Root& r : d_.roots) boxes.push_back(Box::around(point(r.a), point(r.b)));
    std::vector<std::pair<GlobalRootId, GlobalRootId>> crossing;
    BoxTree(boxes).visit_overlapping([&](std::int32_t i, std::int32_t j) {
      const GlobalRootId r{i}, other{j};
      if (meet_inside(d_.roots[r], d_.roots[other])) crossing.emplace_back(r, other);
    });
    std::sort(crossing.begin(), crossing.end());
    for (const auto& [r, other] : crossing) problem("roots " + to_string(r) + " and " + to_string(other) + " cross");
  }

  /// Whether two roots share a point that is not an end of both.
  [[nodiscard]] bool meet_inside(const Decomposition::Root& r, const Decomposition::Root& s) const {
    const auto side = [&](GlobalPointId a, GlobalPointId b, GlobalPointId c) {
      return orient2d(point(a), point(b), point(c));
    };
    if (r.a == s.a && r.b == s.b) return true;
    const bool share = r.a == s.a || r.a == s.b || r.b == s.a || r.b == s.b;
    if (share) return overlap_at_common_end(r, s);
    const double ra = side(s.a, s.b, r.a), rb = side(s.a, s.b, r.b);
    const double sa = side(r.a, r.b, s.a), sb = side(r.a, r.b, s.b);
    if (ra == 0 && rb == 0) return true;  // collinear, and their boxes overlap
    return opposite(ra, rb) && opposite(sa, sb);
  }
  static bool opposite(double u, double v) { return (u >= 0 && v <= 0) || (u <= 0 && v >= 0); }

  [[nodiscard]] bool overlap_at_common_end(const Decomposition::Root& r, const Decomposition::Root& s) const {
    const GlobalPointId common = r.a == s.a || r.a == s.b ? r.a : r.b;
    const Point &o = point(common), &p = point(r.a == common ? r.b : r.a), &q = point(s.a == common ? s.b : s.a);
    return orient2d(o, p, q) == 0 && (p.x - o.x) * (q.x - o.x) + (p.y - o.y) * (q.y - o.y) > 0;
  }

  /// Sorts the darts at every point by angle, which yields the loops of the borders, and checks each sector.
  void check_points() {
    std::vector<std::size_t> begin(d_.points.size() + 1, 0);  // where each point's darts begin; later, where they end
    const auto darts = static_cast<Dart>(2 * d_.roots.size());
    for (Dart e = 0; e < darts; ++e) ++begin[to_index(start(e)) + 1];
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    std::vector<Dart> sorted(to_index(darts));
    for (Dart e = 0; e < darts; ++e) sorted[begin[to_index(start(e))]++] = e;
    for (std::size_t v = 0, i = 0; v < d_.points.size(); i = begin[v++])
      check_point({sorted.begin() + i, sorted.begin() + begin[v]});
  }

  void check_point(std::span<Dart> darts) {
    std::sort(darts.begin(), darts.end(), [&](Dart e, Dart f) { return before(e, f); });
    for (std::size_t k = 0; k < darts.size(); ++k) check_sector(darts[k], darts[k + 1 < darts.size() ? k + 1 : 0]);
  }

  /// Counterclockwise order of darts with a common start, beginning at the positive x axis.
  [[nodiscard]] bool before(Dart e, Dart f) const {
    const Point &o = point(start(e)), &p = point(end(e)), &q = point(end(f));
    const auto lower = [&](const Point& r) { return r.y < o.y || (r.y == o.y && r.x < o.x); };
    if (lower(p) != lower(q)) return lower(q);
    const double turn = orient2d(o, p, q);
    return turn != 0 ? turn > 0 : e < f;
  }

  /// The sector from dart e counterclockwise to dart f.
  void check_sector(Dart e, Dart f) {
    next_[f ^ 1] = e;  // a border comes in along f and leaves along e, the sector on its left
    if (left(e) != left(f ^ 1) || (left(e) != kNoSubdomain && left_region(e) != left_region(f ^ 1)))
      problem("at " + place(start(e)) + ", roots " + to_string(root_of(e)) + " and " + to_string(root_of(f)) +
              " disagree on the subdomain between them: " + to_string(left(e)) + " and " + to_string(left(f ^ 1)));
    if (left(e) == kNoSubdomain || e == f || (!root(e).separator && !root(f).separator)) return;
    const Point &o = point(start(e)), &p = point(end(e)), &q = point(end(f));
    if (orient2d(o, p, q) < 0) return;  // more than 180 degrees
    const double angle = angle_at(p, o, q) * 180 / std::numbers::pi;
    ++report_.angle_histogram[static_cast<std::size_t>(std::min(angle, 179.0) / 10)];
    if (angle >= report_.smallest_angle) return;
    report_.smallest_angle = angle;
    report_.smallest_at = start(e);
  }

  /// Follows every border. Each subdomain must have exactly one outer border, and the area that it claims.
  void check_borders() {
    IdVector<SubdomainId, double> area(d_.size(), 0);
    IdVector<Border, SubdomainId> subdomain_of;
    IdVector<Border, double> enclosed;
    IdVector<Dart, Border> border_of(next_.size(), kNone);
    for (const Dart first : ids_of(next_)) {
      const SubdomainId s = left(first);
      if (border_of[first] != kNone || s == kNoSubdomain) continue;
      enclosed.push_back(follow(first, subdomain_of.next_id(), border_of));
      subdomain_of.push_back(s);
      area[s] += enclosed.back();
    }
    const IdVector<SubdomainId, int> outer = count_outer(subdomain_of, enclosed, border_of);
    for (const double a : area) report_.area += a;
    for (const SubdomainId i : ids_of(d_.subdomains)) {
      if (outer[i] == 0 || (outer[i] > 1 && has_interface(i)))
        problem("subdomain " + to_string(i) + " has " + std::to_string(outer[i]) +
                " outer borders: it is not connected");
      if (!(std::fabs(area[i] - d_.subdomains[i].area) <= 1e-9 * report_.area))
        problem(formatted("subdomain {} claims area {}, its border encloses {}", to_string(i), d_.subdomains[i].area,
                          area[i]));
    }
  }

  /// Only subdomains without interfaces may have several parts, which are then parts of the domain.
  [[nodiscard]] bool has_interface(SubdomainId i) const {
    return std::ranges::any_of(
        d_.roots, [&](const Decomposition::Root& r) { return r.is_interface() && (r.left == i || r.right == i); });
  }

  /// The outer borders of each subdomain. Borders on both sides of a root inside the subdomain count as one; those that
  /// include the border of a hole lie inside another.
  [[nodiscard]] IdVector<SubdomainId, int> count_outer(const IdVector<Border, SubdomainId>& subdomain_of,
                                                       const IdVector<Border, double>& enclosed,
                                                       const IdVector<Dart, Border>& border_of) const {
    DisjointSets sets(enclosed.size());
    for (Dart e = 0; next_.has(e); e += 2)
      if (left(e) != kNoSubdomain && left(e) == left(e + 1)) sets.join(border_of[e], border_of[e + 1]);
    IdVector<Border, bool> inside(enclosed.size(), false), proper(enclosed.size(), false);
    for (const Border b : ids_of(enclosed)) (enclosed[b] > 0 ? proper : inside)[sets.find(b)] = true;
    IdVector<SubdomainId, int> outer(d_.size(), 0);
    for (const Border b : ids_of(enclosed)) outer[subdomain_of[b]] += proper[b] && !inside[b];
    return outer;
  }

  double follow(Dart first, Border border, IdVector<Dart, Border>& border_of) const {
    const Point& o = point(start(first));
    double twice_area = 0;
    for (Dart e = first; border_of[e] == kNone; e = next_[e]) {
      border_of[e] = border;
      const Point &a = point(start(e)), &b = point(end(e));
      twice_area += (a.x - o.x) * (b.y - o.y) - (a.y - o.y) * (b.x - o.x);
    }
    return twice_area / 2;
  }

  void check_lists() {
    Decomposition copy;
    copy.roots = d_.roots;
    copy.subdomains = d_.subdomains;
    list_roots(copy);
    if (copy.root_begin != d_.root_begin || copy.root_list != d_.root_list)
      problem("the lists of roots do not agree with the sides of the roots");
    if (d_.point_begin.size() != d_.size() + 1 || to_index(d_.point_begin.back()) != d_.point_list.size() ||
        !std::is_sorted(d_.point_begin.begin(), d_.point_begin.end()) || d_.point_begin.front() != 0)
      problem("the lists of inner points are broken");
    for (const GlobalPointId v : d_.point_list)
      if (!d_.points.has(v)) problem("inner point " + to_string(v) + " does not exist");
  }

  /// Above a point inside a subdomain an odd number of roots have it on one side.
  void check_inner_points() {
    if (!report_.problems.empty()) return;  // the lists may name nothing
    for (const SubdomainId i : ids_of(d_.subdomains))
      for (const GlobalPointId v : d_.inner_points_of(i)) {
        const auto is_above = [&](GlobalRootId r) {
          const Decomposition::Root& root = d_.roots[r];
          const bool rightward = point(root.a).x < point(root.b).x;
          const Point &west = point(rightward ? root.a : root.b), &east = point(rightward ? root.b : root.a);
          return root.left != root.right && west.x <= point(v).x && point(v).x < east.x &&
                 orient2d(west, east, point(v)) < 0;
        };
        if (std::ranges::count_if(d_.roots_of(i), is_above) % 2 == 0)
          problem("inner " + place(v) + " is listed in subdomain " + to_string(i) + ", in which it does not lie");
      }
  }

  void measure() {
    for (const Decomposition::Root& r : d_.roots) {
      const double length = std::sqrt(squared_distance(point(r.a), point(r.b)));
      if (r.separator) report_.separator_length += length;
      if (r.left == kNoSubdomain || r.right == kNoSubdomain) report_.border_length += length;
    }
    double work = 0, most = 0, least = kNoWork;
    for (const Decomposition::Subdomain& s : d_.subdomains) {
      work += s.predicted;
      most = std::max(most, s.predicted);
      least = std::min(least, s.predicted);
    }
    const double mean = work / static_cast<double>(d_.size());
    report_.largest_load = most / mean;
    report_.smallest_load = least / mean;
  }

  static constexpr double kNoWork = 1e300;
  const Decomposition& d_;
  DecompositionReport report_;
  IdVector<Dart, Dart> next_;  // along the border left of a dart
};

}  // namespace

DecompositionReport check_decomposition(const Decomposition& decomposition) {
  return Checker(decomposition).run();
}

}  // namespace driftmesh
