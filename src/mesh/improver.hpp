#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "driftmesh/error.hpp"
#include "geometry/midpoint.hpp"
#include "geometry/triangle_geometry.hpp"
#include "mesh/area_bounds.hpp"
#include "mesh/bounds.hpp"
#include "mesh/cavity.hpp"
#include "mesh/corners.hpp"
#include "mesh/flips.hpp"
#include "mesh/refiner_state.hpp"
#include "mesh/triangulation.hpp"

namespace driftmesh {

/// How refinement changes a mesh, in whatever order: inserts a point that improves a triangle, or splits the segment
/// that it would encroach upon. Which triangle is next, `Order` knows, which derives from this and is told what has
/// changed, at compile time, since this is the inner loop:
///
///     void note_fresh();                         // the triangles that cavity_ has just made
///     void note(TriangleId t, const Shape& s);   // one that deleting a vertex has changed
template <class Order>
class Improver {
 public:
  /// The points that refinement has put on segments since the last call, in the order of insertion, so each after its
  /// ancestors. Those that add_split_point inserted are not among them.
  [[nodiscard]] std::vector<SplitPoint<RootId>> take_split_points() { return std::exchange(state_.made, {}); }

  /// Inserts point `path` of `root`, after the points that must exist before it (its ancestors). Does nothing if it is
  /// there already. Returns false if the depth or the precision of coordinates does not allow it.
  bool add_split_point(RootId root, dyadic::Path path) {
    for (;;) {
      const SubsegmentId s = mesh_.descend(root, path);
      if (!mesh_.subsegments[s].is_leaf()) return true;
      if (!split(s)) return false;
    }
  }

  [[nodiscard]] const RefineCounters& counters() const { return state_.counters; }

 protected:
  enum class Progress { kChanged, kStuck };
  struct Shape {
    double twice_area;
    double shortest, longest;  // squared lengths
    double longer_two;         // the product of their squared lengths
  };

  /// Throws Error if the angle bound lies outside [0, kMaxAngle], and if the state has a fault.
  Improver(Triangulation& mesh, double min_angle, const SizeBounds& sizes, RefinerState state)
      : mesh_(mesh),
        min_angle_(min_angle),
        cavity_(mesh),
        areas_(mesh, sizes, kMarginOfRefinement),
        state_(std::move(state)) {
    require_possible(min_angle);
    // The relative margin makes the bound hold for readers of the file, which may round differently.
    const double sine = std::sin(radians(min_angle));
    sin_squared_ = sine * sine * (1 + 1e-9);
    off_center_factor_ = min_angle > 0 ? off_center_factor(min_angle) : 0;
    lens_.cos_squared = cos_squared_of_lens(min_angle);
    if (const std::string fault = state_.fault(mesh, sizes); !fault.empty())
      throw Error("the state of refinement does not fit its mesh: " + fault);
  }

  // ---- Shapes ----

  static Shape shape(double twice_area, double ab, double bc, double ca) {
    return {twice_area, std::min(ab, std::min(bc, ca)), std::max(ab, std::max(bc, ca)),
            std::max(ab * bc, std::max(bc * ca, ca * ab))};
  }
  [[nodiscard]] Shape shape_of(TriangleId t, double twice_area) const {
    const Point &a = mesh_.corner(t, 0), &b = mesh_.corner(t, 1), &c = mesh_.corner(t, 2);
    return shape(twice_area, squared_distance(a, b), squared_distance(b, c), squared_distance(c, a));
  }
  [[nodiscard]] Shape shape_of(TriangleId t) const { return shape_of(t, twice_area(t)); }
  [[nodiscard]] double twice_area(TriangleId t) const {
    return 2 * signed_area(mesh_.corner(t, 0), mesh_.corner(t, 1), mesh_.corner(t, 2));
  }
  /// Whether the smallest angle is below the bound: its sine is twice the area over the product of the two longer
  /// edges. Fourth powers of lengths cannot overflow for any coordinate that is allowed; sixth powers could.
  [[nodiscard]] bool is_skinny(const Shape& s) const {
    return s.twice_area * s.twice_area < sin_squared_ * s.longer_two;
  }
  [[nodiscard]] Point circumcenter_of(TriangleId t) const {
    return circumcenter(mesh_.corner(t, 0), mesh_.corner(t, 1), mesh_.corner(t, 2));
  }
  [[nodiscard]] Point off_center_of(TriangleId t) const {
    return off_center_of_triangle(mesh_.corner(t, 0), mesh_.corner(t, 1), mesh_.corner(t, 2), off_center_factor_);
  }

  // ---- Insertion ----

  /// From now on points are inserted by these rules. Before the first one.
  void follow(const InsertionRules& rules) {
    rules_ = rules;
    if (rules.conforming) lens_.cos_squared = 0;
  }

  /// Inserts a point inside of triangle t, however near to a segment.
  Progress insert_inside(TriangleId t, const Point& p) {
    if (cavity_.gather(p, t, {.cos_squared = 1}) != Cavity::Found::kClear) return Progress::kStuck;
    cavity_.fill(add_vertex(p, kFree));
    ++state_.counters.free_points;
    order().note_fresh();
    return Progress::kChanged;
  }

  /// Inserts p, a point in the circumdisk of triangle t, or splits the segment that it encroaches upon.
  Progress improve(TriangleId t, const Point& p) {
    if (!std::isfinite(p.x) || !std::isfinite(p.y)) return Progress::kStuck;
    switch (cavity_.gather(p, t, lens_)) {
      case Cavity::Found::kClear:
        cavity_.fill(add_vertex(p, kFree));
        ++state_.counters.free_points;
        order().note_fresh();
        return Progress::kChanged;
      case Cavity::Found::kEncroached:
        ++state_.counters.encroaching;
        return split_and_tell(cavity_.encroached()) ? Progress::kChanged : Progress::kStuck;
      default:
        return Progress::kStuck;
    }
  }

  bool split_and_tell(SubsegmentId s) {
    const SplitPoint<RootId> point{mesh_.subsegments[s].root, mesh_.subsegments[s].path};
    if (!split(s)) return false;
    state_.made.push_back(point);
    return true;
  }

  Triangulation& mesh_;
  double min_angle_;
  Cavity cavity_;
  Lens lens_;
  double sin_squared_ = 0;  // for the angle bound, with a margin for rounding
  double off_center_factor_ = 0;
  AreaBounds areas_;
  std::vector<TriangleId> changed_;
  RefinerState state_;
  InsertionRules rules_{};

 private:
  [[nodiscard]] Order& order() { return static_cast<Order&>(*this); }

  static double radians(double degrees) { return degrees * (std::numbers::pi / 180); }

  /// The lens of Chew and Shewchuk: points that see the segment at more than 120 degrees, or at more than 180 degrees
  /// less twice the angle bound where that is smaller, since a segment that does not obstruct the bound need not be
  /// split.
  static double cos_squared_of_lens(double min_angle) {
    const double cosine = std::cos(radians(std::min(120.0, 180 - 2 * min_angle)));
    return cosine * cosine;
  }

  VertexId add_vertex(const Point& p, VertexOrigin origin) {
    const VertexId v = mesh_.add_vertex(p, origin);
    if (areas_.by_place()) {
      if (!state_.size.has(v)) state_.size.resize_uninitialized(to_index(v) + 1);
      state_.size[v] = areas_.sizes().length_at(p);
    }
    return v;
  }

  /// Deletes the free vertices opposite to a segment that see it under more than 90 degrees.
  void clear_diametral_circle(SubsegmentId s) {
    for (const std::size_t side : {0, 1}) {
      for (;;) {
        const Subsegment& segment = mesh_.subsegments[s];
        const HalfEdge h = segment.half[side];
        if (h == kNone) break;
        const VertexId apex = mesh_.apex(h);
        if (mesh_.origin[apex] != kFree) break;
        if (!in_diametral_lens(mesh_.points[apex], mesh_.points[segment.vertex[0]], mesh_.points[segment.vertex[1]], 0))
          break;
        changed_.clear();
        if (!remove_vertex(mesh_, h, changed_)) break;
        ++state_.counters.deleted_points;
        for (const TriangleId t : changed_)
          if (mesh_.triangles[t].alive()) order().note(t, shape_of(t));
      }
    }
  }

  /// Splits leaf s at its midpoint. False if depth, precision or the rules do not allow it.
  bool split(SubsegmentId s) {
    if (rules_.split != InsertionRules::Split::kEverywhere && !may_split(mesh_, s, rules_.split)) return false;
    if (dyadic::depth(mesh_.subsegments[s].path) >= dyadic::kMaxDepth || state_.unsplittable.contains(s)) return false;
    clear_diametral_circle(s);
    const auto [a, b] = mesh_.subsegments[s].vertex;
    const Point m = midpoint(mesh_.points[a], mesh_.points[b]);
    if (cavity_.gather_on(s, m) != Cavity::Found::kClear) {
      // Do not try again: the vertices deleted for it would come back and be deleted again, forever.
      state_.unsplittable.insert(s);
      return false;
    }
    const VertexId v = add_vertex(m, midpoint_of(s));
    const SubsegmentId child = mesh_.halve(s, v);
    cavity_.fill_on(v, child, after(child));
    ++state_.counters.segment_points;
    order().note_fresh();
    return true;
  }
};

}  // namespace driftmesh
