#include "decompose/check_decomposition.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "base/disjoint_sets.hpp"
#include "geometry/box_tree.hpp"
#include "geometry/predicates.hpp"
#include "geometry/triangle_geometry.hpp"

namespace driftmesh {
namespace {

constexpr std::size_t at(std::int32_t i) {
  return static_cast<std::size_t>(i);
}

/// A root seen from one of its ends: 2 * root from a, 2 * root + 1 from b.
using Dart = std::int32_t;

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
      measure();
    }
    return std::move(report_);
  }

 private:
  void problem(const std::string& what) {
    if (report_.problems.size() < DecompositionReport::kMaxProblems) report_.problems.push_back(what);
  }

  [[nodiscard]] const Decomposition::Root& root(Dart e) const { return d_.roots[at(e / 2)]; }
  [[nodiscard]] GlobalPointId start(Dart e) const { return e % 2 == 0 ? root(e).a : root(e).b; }
  [[nodiscard]] GlobalPointId end(Dart e) const { return start(e ^ 1); }
  [[nodiscard]] SubdomainId left(Dart e) const { return e % 2 == 0 ? root(e).left : root(e).right; }
  [[nodiscard]] std::uint16_t left_region(Dart e) const {
    return e % 2 == 0 ? root(e).left_region : root(e).right_region;
  }
  [[nodiscard]] const Point& point(GlobalPointId v) const { return d_.points[at(v)]; }
  [[nodiscard]] std::string place(GlobalPointId v) const {
    return "point " + std::to_string(v) + " (" + std::to_string(point(v).x) + ", " + std::to_string(point(v).y) + ")";
  }

  bool check_ranges() {
    const auto points = static_cast<GlobalPointId>(d_.points.size());
    const auto subdomains = static_cast<SubdomainId>(d_.size());
    if (d_.origin.size() != d_.points.size())
      problem(std::to_string(d_.points.size()) + " points but " + std::to_string(d_.origin.size()) + " origins");
    const auto in_range = [](double x) {
      return x == 0 || (std::fabs(x) >= kSmallestCoordinate && std::fabs(x) <= kMaxCoordinate);
    };
    for (std::size_t v = 0; v < d_.points.size(); ++v)
      if (!in_range(d_.points[v].x) || !in_range(d_.points[v].y))
        problem("point " + std::to_string(v) + " has a coordinate out of range");
    const auto is_subdomain = [&](SubdomainId s) { return s >= -1 && s < subdomains; };
    for (std::size_t r = 0; r < d_.roots.size(); ++r) {
      const Decomposition::Root& root = d_.roots[r];
      const std::string name = "root " + std::to_string(r) + " ";
      if (!(root.a >= 0 && root.a < root.b && root.b < points))
        problem(name + "joins points " + std::to_string(root.a) + " and " + std::to_string(root.b) + " of " +
                std::to_string(points));
      if (!is_subdomain(root.left) || !is_subdomain(root.right) || (root.left == kNone && root.right == kNone))
        problem(name + "lies between subdomains " + std::to_string(root.left) + " and " + std::to_string(root.right) +
                " of " + std::to_string(subdomains));
      if (root.separator && (root.left == kNone || root.right == kNone || root.left == root.right))
        problem(name + "is a separator without two subdomains");
    }
    return report_.problems.empty();
  }

  void check_crossings() {
    std::vector<Box> boxes;
    for (const Decomposition::Root& r : d_.roots) boxes.push_back(Box::around(point(r.a), point(r.b)));
    const BoxTree tree(boxes);
    for (std::size_t r = 0; r < d_.roots.size(); ++r)
      tree.search([&](const Box& box) { return box.overlaps(boxes[r]); },
                  [&](std::int32_t other) {
                    if (at(other) > r && meet_inside(d_.roots[r], d_.roots[at(other)]))
                      problem("roots " + std::to_string(r) + " and " + std::to_string(other) + " cross");
                  });
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
    if (ra == 0 && rb == 0) return true;  // on one line, and their boxes overlap
    return opposite(ra, rb) && opposite(sa, sb);
  }
  static bool opposite(double u, double v) { return (u >= 0 && v <= 0) || (u <= 0 && v >= 0); }

  [[nodiscard]] bool overlap_at_common_end(const Decomposition::Root& r, const Decomposition::Root& s) const {
    const GlobalPointId common = r.a == s.a || r.a == s.b ? r.a : r.b;
    const Point &o = point(common), &p = point(r.a == common ? r.b : r.a), &q = point(s.a == common ? s.b : s.a);
    return orient2d(o, p, q) == 0 && (p.x - o.x) * (q.x - o.x) + (p.y - o.y) * (q.y - o.y) > 0;
  }

  /// Sorts the darts of every point by angle, which gives the loops of the borders, and looks at each sector.
  void check_points() {
    std::vector<Dart> darts(2 * d_.roots.size());
    std::iota(darts.begin(), darts.end(), 0);
    std::sort(darts.begin(), darts.end(),
              [&](Dart e, Dart f) { return start(e) != start(f) ? start(e) < start(f) : before(e, f); });
    for (std::size_t i = 0, j = 0; i < darts.size(); i = j) {
      while (j < darts.size() && start(darts[j]) == start(darts[i])) ++j;
      for (std::size_t k = i; k < j; ++k) check_sector(darts[k], darts[k + 1 < j ? k + 1 : i]);
    }
  }

  /// Counterclockwise order of darts with a common start, from the positive x axis on.
  [[nodiscard]] bool before(Dart e, Dart f) const {
    const Point &o = point(start(e)), &p = point(end(e)), &q = point(end(f));
    const auto lower = [&](const Point& r) { return r.y < o.y || (r.y == o.y && r.x < o.x); };
    if (lower(p) != lower(q)) return lower(q);
    const double turn = orient2d(o, p, q);
    return turn != 0 ? turn > 0 : e < f;
  }

  /// The sector from dart e counterclockwise to dart f.
  void check_sector(Dart e, Dart f) {
    next_[at(f ^ 1)] = e;  // a border comes in along f and leaves along e, the sector on its left
    if (left(e) != left(f ^ 1) || (left(e) != kNone && left_region(e) != left_region(f ^ 1)))
      problem("at " + place(start(e)) + ", roots " + std::to_string(e / 2) + " and " + std::to_string(f / 2) +
              " disagree about the subdomain between them: " + std::to_string(left(e)) + " and " +
              std::to_string(left(f ^ 1)));
    if (left(e) == kNone || e == f || (!root(e).separator && !root(f).separator)) return;
    const Point &o = point(start(e)), &p = point(end(e)), &q = point(end(f));
    if (orient2d(o, p, q) < 0) return;  // more than 180 degrees
    const double angle = angle_at(p, o, q) * 180 / std::numbers::pi;
    ++report_.angle_histogram[static_cast<std::size_t>(std::min(angle, 179.0) / 10)];
    if (angle >= report_.smallest_angle) return;
    report_.smallest_angle = angle;
    report_.smallest_at = start(e);
  }

  /// Follows every border: of each subdomain, one that is not connected with a hole's goes around it counterclockwise.
  void check_borders() {
    std::vector<double> area(d_.size(), 0);
    std::vector<SubdomainId> subdomain_of;  // of each border
    std::vector<double> enclosed;
    std::vector<std::int32_t> border_of(next_.size(), kNone);
    for (std::size_t first = 0; first < next_.size(); ++first) {
      const SubdomainId s = left(static_cast<Dart>(first));
      if (border_of[first] != kNone || s == kNone) continue;
      enclosed.push_back(follow(static_cast<Dart>(first), static_cast<std::int32_t>(subdomain_of.size()), border_of));
      subdomain_of.push_back(s);
      area[at(s)] += enclosed.back();
    }
    const std::vector<int> outer = count_outer(subdomain_of, enclosed, border_of);
    for (const double a : area) report_.area += a;
    for (std::size_t i = 0; i < d_.size(); ++i) {
      if (outer[i] != 1)
        problem("subdomain " + std::to_string(i) + " has " + std::to_string(outer[i]) +
                " outer borders: it is not connected");
      if (!(std::fabs(area[i] - d_.subdomains[i].area) <= 1e-9 * report_.area))
        problem("subdomain " + std::to_string(i) + " claims area " + std::to_string(d_.subdomains[i].area) +
                ", its border encloses " + std::to_string(area[i]));
    }
  }

  /// The outer borders of each subdomain. Borders on both sides of a root inside the subdomain count as one; those that
  /// include the border of a hole lie inside another.
  [[nodiscard]] std::vector<int> count_outer(const std::vector<SubdomainId>& subdomain_of,
                                             const std::vector<double>& enclosed,
                                             const std::vector<std::int32_t>& border_of) const {
    DisjointSets sets(enclosed.size());
    for (Dart e = 0; at(e) < next_.size(); e += 2)
      if (left(e) != kNone && left(e) == left(e + 1)) sets.join(border_of[at(e)], border_of[at(e + 1)]);
    std::vector<bool> inside(enclosed.size(), false), proper(enclosed.size(), false);
    for (std::size_t b = 0; b < enclosed.size(); ++b) {
      const auto set = at(sets.find(static_cast<std::int32_t>(b)));
      (enclosed[b] > 0 ? proper : inside)[set] = true;
    }
    std::vector<int> outer(d_.size(), 0);
    for (std::size_t b = 0; b < enclosed.size(); ++b) outer[at(subdomain_of[b])] += proper[b] && !inside[b];
    return outer;
  }

  double follow(Dart first, std::int32_t border, std::vector<std::int32_t>& border_of) const {
    const Point& o = point(start(first));
    double twice_area = 0;
    for (Dart e = first; border_of[at(e)] == kNone; e = next_[at(e)]) {
      border_of[at(e)] = border;
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
    if (d_.point_begin.size() != d_.size() + 1 || at(d_.point_begin.back()) != d_.point_list.size() ||
        !std::is_sorted(d_.point_begin.begin(), d_.point_begin.end()) || d_.point_begin.front() != 0)
      problem("the lists of inner points are broken");
    for (const GlobalPointId v : d_.point_list)
      if (v < 0 || at(v) >= d_.points.size()) problem("inner point " + std::to_string(v) + " does not exist");
  }

  void measure() {
    for (const Decomposition::Root& r : d_.roots) {
      const double length = std::sqrt(squared_distance(point(r.a), point(r.b)));
      if (r.separator) report_.separator_length += length;
      if (r.left == kNone || r.right == kNone) report_.border_length += length;
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
  std::vector<Dart> next_;  // along the border left of a dart
};

}  // namespace

DecompositionReport check_decomposition(const Decomposition& decomposition) {
  return Checker(decomposition).run();
}

}  // namespace driftmesh
