#include "patch/domain.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "base/formatted.hpp"
#include "driftmesh/error.hpp"
#include "geometry/triangle_geometry.hpp"

namespace driftmesh::patch {
namespace {

/// A segment with region labels on its sides.
struct Border {
  std::int32_t a, b;
  SegmentSides sides;
  std::int32_t marker = 0;
  bool fixed = false;

  [[nodiscard]] Border turned() const { return {b, a, {sides.right, sides.left}, marker, fixed}; }
  [[nodiscard]] Border from(std::int32_t v) const { return a == v ? *this : turned(); }
};

/// Attributes of regions by label; 0 is the label of what is in no region.
class Labels {
 public:
  std::int32_t of(double attribute) {
    const auto [at, is_new] = labels_.try_emplace(attribute, static_cast<std::int32_t>(attributes.size()));
    if (is_new) attributes.push_back(attribute);
    return at->second;
  }
  std::vector<double> attributes{0};

 private:
  std::map<double, std::int32_t> labels_{{0, 0}};
};

class Builder {
 public:
  Builder(const Part& part, const Extent& extent, const OldPlaces& old)
      : part_(part),
        mesh_(part.mesh),
        extent_(extent),
        old_(old),
        index_(part.mesh),
        core_(mesh_.points.size(), true),
        places_(mesh_.points),
        held_(extent.held) {
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t)
      if (!extent.inside[t])
        for (const std::int32_t v : mesh_.triangles[t]) core_[to_index(v)] = false;
  }

  Domain run() {
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t)
      if (extent_.taken[t]) add_borders(t);
    for (const Piece& piece : extent_.pieces) add_piece(piece);
    fuse_chains();
    require_single_lines();
    return domain();
  }

 private:
  void add_borders(std::size_t t) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::int32_t a = mesh_.triangles[t][(i + 1) % 3], b = mesh_.triangles[t][(i + 2) % 3];
      const std::int32_t other = part_.beyond[t][i], listed = index_.find(a, b);
      const bool shared = other >= 0 && extent_.taken[to_index(other)];
      if (listed >= 0 && !extent_.gone.empty() && extent_.gone[to_index(listed)]) continue;
      if (shared && (std::cmp_less(other, t) || (listed < 0 && region(t) == region(to_index(other))))) continue;
      const std::int32_t right = shared ? labels_.of(region(to_index(other))) : kNone;
      borders_.push_back({a,
                          b,
                          {labels_.of(region(t)), right},
                          listed < 0 ? 0 : mesh_.edges[to_index(listed)].marker,
                          other >= 0 && !shared});
    }
  }

  void add_piece(const Piece& piece) {
    std::array<std::int32_t, 2> ends{};
    for (std::size_t i = 0; i < 2; ++i) {
      ends[i] = end_of(piece.end[i]);
      std::int32_t& marker = end_markers_[ends[i]];
      if (marker == 0) marker = piece.end_marker[i];
    }
    const auto label = [&](const std::optional<double>& region) { return region ? labels_.of(*region) : kNone; };
    if (ends[0] != ends[1])
      borders_.push_back({ends[0], ends[1], {label(piece.left), label(piece.right)}, piece.marker, false});
  }

  /// The end of a piece is a point of the part, or one more.
  std::int32_t end_of(const Point& p) {
    if (const std::int32_t v = old_.point_at(p); v >= 0) {
      if (end_markers_.try_emplace(v, 0).second) ends_.push_back(v);
      return v;
    }
    const auto [at, is_new] = added_.try_emplace(std::pair(p.x, p.y), static_cast<std::int32_t>(places_.size()));
    if (is_new) {
      places_.push_back(p);
      held_.push_back(true);
      core_.push_back(false);
      ends_.push_back(at->second);
    }
    return at->second;
  }

  [[nodiscard]] bool is_added(std::size_t v) const { return v >= mesh_.points.size(); }
  [[nodiscard]] bool is_marked(std::size_t v) const {
    return !is_added(v) && !mesh_.point_markers.empty() && mesh_.point_markers[v] != 0;
  }
  [[nodiscard]] double region(std::size_t t) const { return mesh_.regions.empty() ? 0 : mesh_.regions[t]; }

  // ---- Chains in line ----

  /// Rounded midpoints are that near to a line.
  [[nodiscard]] static bool in_line(const Point& a, const Point& b, const Point& c) {
    const double most = std::max({std::fabs(a.x), std::fabs(a.y), std::fabs(c.x), std::fabs(c.y)});
    const double near = 4 * std::numeric_limits<double>::epsilon() * most;
    const bool between = (b.x - a.x) * (c.x - b.x) + (b.y - a.y) * (c.y - b.y) > 0;
    return between && std::fabs(rounded_cross(a, c, b)) <= near * std::sqrt(squared_distance(a, c));
  }

  /// The two borders at a point where they may become one, in line from the first to the second.
  [[nodiscard]] bool is_joint(std::int32_t v, const std::vector<std::size_t>& at) const {
    if (!core_[to_index(v)] || held_[to_index(v)] || at.size() != 2) return false;
    const Border in = borders_[at[0]].from(v).turned(), out = borders_[at[1]].from(v);
    if (in.marker != out.marker || in.sides.left != out.sides.left || in.sides.right != out.sides.right) return false;
    if (!mesh_.point_markers.empty() && mesh_.point_markers[to_index(v)] != in.marker) return false;
    return in_line(places_[to_index(in.a)], places_[to_index(v)], places_[to_index(out.b)]);
  }

  void fuse_chains() {
    std::vector<std::vector<std::size_t>> at(places_.size());
    for (std::size_t i = 0; i < borders_.size(); ++i)
      for (const std::int32_t v : {borders_[i].a, borders_[i].b}) at[to_index(v)].push_back(i);
    on_border_.assign(places_.size(), false);
    std::vector<bool> joint(places_.size(), false);
    for (std::size_t v = 0; v < at.size(); ++v) {
      on_border_[v] = !at[v].empty();
      joint[v] = is_joint(static_cast<std::int32_t>(v), at[v]);
    }
    std::vector<bool> done(borders_.size(), false);
    std::vector<Border> fused;
    for (std::size_t v = 0; v < at.size(); ++v) {
      if (joint[v]) continue;
      for (const std::size_t first : at[v]) {
        if (done[first]) continue;
        std::vector<std::size_t> chain{first};
        std::vector<std::int32_t> points{static_cast<std::int32_t>(v)};
        for (;;) {
          done[chain.back()] = true;
          const std::int32_t end = borders_[chain.back()].from(points.back()).b;
          points.push_back(end);
          if (!joint[to_index(end)]) break;
          chain.push_back(at[to_index(end)][0] == chain.back() ? at[to_index(end)][1] : at[to_index(end)][0]);
        }
        add_chain(chain, points, fused);
      }
    }
    borders_ = std::move(fused);
  }

  void add_chain(const std::vector<std::size_t>& chain, const std::vector<std::int32_t>& points,
                 std::vector<Border>& fused) {
    const auto place = [&](std::size_t i) { return places_[to_index(points[i])]; };
    bool straight = true;  // also as a whole
    for (std::size_t i = 1; i + 1 < points.size(); ++i)
      straight = straight && in_line(place(0), place(i), place(points.size() - 1));
    if (straight) {
      Border whole = borders_[chain[0]].from(points[0]);
      whole.b = points.back();
      fused.push_back(whole);
      for (std::size_t i = 1; i + 1 < points.size(); ++i) on_border_[to_index(points[i])] = false;
      gone_.insert(gone_.end(), points.begin() + 1, points.end() - 1);
    } else {
      for (std::size_t i = 0; i < chain.size(); ++i) fused.push_back(borders_[chain[i]].from(points[i]));
    }
  }

  /// A large tolerance puts several lines of the old outline on one of the new.
  void require_single_lines() const {
    std::vector<std::pair<std::int32_t, std::int32_t>> ends;
    for (const Border& border : borders_) ends.emplace_back(std::min(border.a, border.b), std::max(border.a, border.b));
    std::ranges::sort(ends);
    const auto twice = std::ranges::adjacent_find(ends);
    if (twice == ends.end()) return;
    const Point &a = places_[to_index(twice->first)], &b = places_[to_index(twice->second)];
    throw Error(formatted(
        "between ({}, {}) and ({}, {}) several lines are within the tolerance of one; ask for a smaller tolerance", a.x,
        a.y, b.x, b.y));
  }

  // ---- The result ----

  [[nodiscard]] bool stays(std::size_t v) const {
    if (on_border_[v] || held_[v]) return true;
    if (!extent_.dropped.empty() && extent_.dropped[v]) return false;
    return !core_[v] || is_marked(v);
  }

  Domain domain() {
    Domain domain;
    std::vector<bool> used(places_.size(), false);
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t)
      if (extent_.taken[t])
        for (const std::int32_t v : mesh_.triangles[t]) used[to_index(v)] = true;
    for (const std::int32_t v : ends_) used[to_index(v)] = true;
    for (const std::int32_t v : gone_) used[to_index(v)] = false;
    std::vector<std::int32_t> number(places_.size(), kNone);
    for (std::size_t v = 0; v < number.size(); ++v) {
      if (!used[v] || !stays(v)) continue;
      number[v] = static_cast<std::int32_t>(domain.pslg.points.size());
      domain.pslg.points.push_back(places_[v]);
      const auto end = end_markers_.find(static_cast<std::int32_t>(v));
      domain.pslg.point_markers.push_back(end == end_markers_.end() ? 0 : end->second);
      domain.free.push_back(!on_border_[v] && !held_[v] && !is_marked(v));
    }
    for (const Border& border : borders_) {
      const std::int32_t a = number[to_index(border.a)], b = number[to_index(border.b)];
      domain.pslg.segments.push_back({std::min(a, b), std::max(a, b), border.marker});
      domain.sides.push_back(a < b ? border.sides : SegmentSides{border.sides.right, border.sides.left});
      domain.fixed.push_back(border.fixed);
    }
    for (const double attribute : labels_.attributes)
      domain.pslg.regions.push_back({.at = {}, .attribute = attribute, .max_area = 0});
    domain.pslg.regions.erase(domain.pslg.regions.begin());  // what has no region
    return domain;
  }

  const Part& part_;
  const Mesh& mesh_;
  const Extent& extent_;
  const OldPlaces& old_;
  ConstrainedEdgeIndex index_;
  std::vector<bool> core_;     // points all of whose triangles are inside
  std::vector<Point> places_;  // those of the points of the part, and behind them of those that pieces add
  std::vector<bool> held_;
  std::map<std::pair<double, double>, std::int32_t> added_;
  std::vector<std::int32_t> ends_;                    // where pieces end
  std::map<std::int32_t, std::int32_t> end_markers_;  // by their numbers
  Labels labels_;
  std::vector<Border> borders_;
  std::vector<bool> on_border_;     // points
  std::vector<std::int32_t> gone_;  // points within segments that were fused
};

}  // namespace

Domain domain_of(const Part& part, const Extent& extent, const OldPlaces& old) {
  return Builder(part, extent, old).run();
}

}  // namespace driftmesh::patch
