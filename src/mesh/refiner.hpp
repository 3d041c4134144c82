#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "geometry/triangle_geometry.hpp"
#include "mesh/area_bounds.hpp"
#include "mesh/bounds.hpp"
#include "mesh/cavity.hpp"
#include "mesh/refiner_state.hpp"
#include "mesh/triangulation.hpp"

namespace driftmesh {

/// Delaunay refinement of one subdomain: inserts circumcenters and off-centers of triangles that miss the bounds, and
/// midpoints of constrained segments that such a point would encroach upon, until every triangle meets the bounds.
///
/// Segments are protected by diametral lenses; before one is split, the free vertices that see it under more than 90
/// degrees are deleted (Chew 1993; both are needed for bounds above 31 degrees, and the deletion for termination when
/// neighbors split a shared segment at any time). Triangles that are too large are split in sweeps over the mesh, first
/// with a coarse version of the bound, then with the bound itself; after them skinny ones, shortest edge first.
///
/// Deterministic: the order depends on the mesh alone. Refinement can stop after any number of insertions and continue
/// later, and split points can be added in between. Once the bounds are met, what is refined on after further split
/// points depends on the triangles alone, not on their slots or first corners.
class Refiner {
 public:
  /// `mesh` must outlive the refiner, and only the refiner may change it. Throws Error if a bound is NaN or the angle
  /// bound lies outside [0, kMaxAngle].
  Refiner(Triangulation& mesh, const QualityBounds& bounds);

  enum class Status {
    kDone,    ///< every triangle meets the bounds, except for those that exceptions.hpp explains
    kBudget,  ///< stopped after the given number of insertions; call again
    kFull,    ///< the mesh has reached the limit on triangles
  };
  /// Refines until all is done or about `insertions` points have been inserted.
  Status refine(std::int64_t insertions);
  Status refine() { return refine(INT64_MAX); }

  /// Stop at this many live triangles (kFull). Default: the capacity of the handles.
  void limit_triangles(std::int64_t most) { state_.max_triangles = std::min(most, kMaxTriangles - 64); }

  /// Inserts point `path` of `root`, after the points that must exist before it (its ancestors). Does nothing if it is
  /// there already. Returns false if the depth or the precision of coordinates does not allow it.
  bool add_split_point(RootId root, dyadic::Path path);

  /// The points that refinement has put on segments since the last call, in the order of insertion, so each after its
  /// ancestors. Those that add_split_point inserted are not among them.
  [[nodiscard]] std::vector<SplitPoint<RootId>> take_split_points() { return std::exchange(state_.made, {}); }

  [[nodiscard]] const RefineCounters& counters() const { return state_.counters; }

  // Instead of refine(), for methods that have an order of their own:

  /// From now on, triangles that change are appended to `touched` (some more than once, some dead by then), and this
  /// refiner queues none of them. `touched` outlives it.
  void tell_changes(std::vector<TriangleId>& touched) { touched_ = &touched; }
  /// A point that would improve triangle t; nothing if it meets the bounds, or exceptions.hpp explains it.
  [[nodiscard]] std::optional<Point> wanted(TriangleId t) const;
  /// Inserts p, a point in the circumdisk of triangle t, or splits the segment that it encroaches upon. False if
  /// neither is possible.
  bool insert(TriangleId t, const Point& p);

  [[nodiscard]] const RefinerState& state() const { return state_; }
  /// Continues from a state. Throws Error like the other constructor, and if the state has a fault.
  Refiner(Triangulation& mesh, const QualityBounds& bounds, RefinerState state);

 private:
  using Stage = RefinerState::Stage;
  enum class Progress { kChanged, kStuck };
  struct Shape {
    double twice_area;
    double shortest, longest;  // squared lengths
    double longer_two;         // the product of their squared lengths
  };

  static Shape shape(double twice_area, double ab, double bc, double ca);
  [[nodiscard]] Shape shape_of(TriangleId t, double twice_area) const;
  [[nodiscard]] Shape shape_of(TriangleId t) const { return shape_of(t, twice_area(t)); }
  [[nodiscard]] double twice_area(TriangleId t) const;
  [[nodiscard]] CornerPoints corners(TriangleId t) const {
    return {mesh_.corner(t, 0), mesh_.corner(t, 1), mesh_.corner(t, 2)};
  }
  [[nodiscard]] bool is_large(TriangleId t, double twice_area) const;
  [[nodiscard]] bool is_large_for_size(TriangleId t, double twice_area) const;
  [[nodiscard]] double twice_area_bound(TriangleId t) const;
  [[nodiscard]] bool looks_between() const;
  void look_between();
  /// Whether the smallest angle is below the bound: its sine is twice the area over the product of the two longer
  /// edges. Fourth powers of lengths cannot overflow for any coordinate that is allowed; sixth powers could.
  [[nodiscard]] bool is_skinny(const Shape& s) const {
    return s.twice_area * s.twice_area < sin_squared_ * s.longer_two;
  }

  bool step();
  bool step_segments();
  void fetch_surroundings(TriangleId t) const;
  bool step_large();
  bool step_skinny();
  void enter(Stage stage);
  [[nodiscard]] bool wants_coarse_stage() const;

  Progress improve(TriangleId t, const Point& p);
  bool split(SubsegmentId s);
  bool split_and_tell(SubsegmentId s);
  void clear_diametral_circle(SubsegmentId s);
  void note_fresh();
  void note(TriangleId t, const Shape& s);
  void note_skinny(TriangleId t, const Shape& s);
  VertexId add_vertex(const Point& p, VertexOrigin origin);

  Triangulation& mesh_;
  QualityBounds bounds_;
  Cavity cavity_;
  Lens lens_;
  double sin_squared_ = 0;  // for the angle bound, with a margin for rounding
  double off_center_factor_ = 0;
  AreaBounds areas_;
  double coarsening_ = 1;  // current factor on all area bounds
  std::vector<TriangleId> changed_;
  std::vector<TriangleId>* touched_ = nullptr;  // see tell_changes
  RefinerState state_;
};

}  // namespace driftmesh
