#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

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
/// neighbors split a shared segment at any time). Triangles too large are worked off in sweeps over the mesh, from a
/// coarse version of the bound to the bound itself; then skinny ones, shortest edge first.
///
/// The order is fixed by the mesh alone: the same input gives the same mesh. The object can be stopped after any number
/// of insertions and go on later, and can be told of split points in between.
class Refiner {
 public:
  /// `mesh` must outlive the refiner and be changed by nobody else while it exists. Throws Error for an angle bound
  /// outside [0, kMaxAngle] or NaN bounds.
  Refiner(Triangulation& mesh, const QualityBounds& bounds);

  enum class Status {
    kDone,    ///< every triangle meets the bounds, but for those that exceptions.hpp explains
    kBudget,  ///< stopped after the given number of insertions; call again
    kFull,    ///< the mesh has reached the limit on triangles
  };
  /// Works for at most about `insertions` insertions.
  Status refine(std::int64_t insertions);
  Status refine() { return refine(INT64_MAX); }

  /// Stop at this many live triangles (kFull). Default: what the handles can name.
  void limit_triangles(std::int64_t most) { state_.max_triangles = std::min(most, kMaxTriangles - 64); }

  /// Puts point `path` of `root` into the mesh, with the points that must exist before it (its ancestors). Nothing
  /// happens if it is there. Returns false if the depth or the precision of coordinates does not allow it.
  bool add_split_point(RootId root, dyadic::Path path);

  /// The points that refinement itself has put on segments since the last call, in the order in which it did, each
  /// after its ancestors; none that add_split_point put there.
  [[nodiscard]] std::vector<SplitPoint> take_split_points() { return std::exchange(state_.made, {}); }

  [[nodiscard]] const RefineCounters& counters() const { return state_.counters; }

  [[nodiscard]] const RefinerState& state() const { return state_; }
  /// Goes on from a state. Throws Error like the other, and if the state has a fault.
  Refiner(Triangulation& mesh, const QualityBounds& bounds, RefinerState state);

  /// A forecast of the number of triangles at the end, from the present mesh and the bounds on area and size (the angle
  /// bound adds to it only where no area bound is active). Within a few percent for area-bounded refinement.
  [[nodiscard]] double predict_triangles() const;

 private:
  using Stage = RefinerState::Stage;
  enum class Progress { kChanged, kStuck };
  struct Shape {
    double twice_area;
    double shortest, longest;  // squared lengths
    double longer_two;         // the product of their squared lengths
  };

  static constexpr std::size_t id(std::int32_t i) { return Triangulation::id(i); }
  static Shape shape(double twice_area, double ab, double bc, double ca);
  [[nodiscard]] Shape shape_of(TriangleId t) const;
  [[nodiscard]] double twice_area(TriangleId t) const;
  [[nodiscard]] double constant_bound(TriangleId t) const;
  [[nodiscard]] double twice_area_bound(TriangleId t) const;
  [[nodiscard]] double sized_bound(TriangleId t) const;
  /// Whether the smallest angle is below the bound: its sine is the area's double over the two longer edges' product.
  /// Fourth powers of lengths stay in the range of doubles for all coordinates that are allowed; sixth ones would not.
  [[nodiscard]] bool is_skinny(const Shape& s) const {
    return s.twice_area * s.twice_area < sin_squared_ * s.longer_two;
  }

  bool step();
  bool step_segments();
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
  void note_skinny(TriangleId t, const Shape& s, double bound);
  VertexId add_vertex(const Point& p, VertexOrigin origin);

  Triangulation& mesh_;
  QualityBounds bounds_;
  Cavity cavity_;
  Lens lens_;
  double sin_squared_ = 0;  // of the angle bound, with a margin for rounding
  double off_center_factor_ = 0;
  double coarsening_ = 1;                  // all area bounds are this much larger at the moment
  std::vector<double> twice_area_bounds_;  // by region label
  std::vector<TriangleId> changed_;
  RefinerState state_;
};

}  // namespace driftmesh
