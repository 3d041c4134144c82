#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>

#include "geometry/triangle_geometry.hpp"
#include "mesh/bounds.hpp"
#include "mesh/improver.hpp"
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
class Refiner : private Improver<Refiner> {
 public:
  /// `mesh` must outlive the refiner, and only the refiner may change it. Throws Error if a bound is NaN or the angle
  /// bound lies outside [0, kMaxAngle].
  Refiner(Triangulation& mesh, const QualityBounds& bounds) : Refiner(mesh, bounds.min_angle, bounds) {
    follow(bounds.rules);
  }
  /// The same for any bounds on sizes.
  Refiner(Triangulation& mesh, double min_angle, const SizeBounds& sizes)
      : Refiner(mesh, min_angle, sizes, RefinerState::at_start(mesh, sizes)) {}

  enum class Status {
    kDone,    ///< every triangle meets the bounds, except for those that exceptions.hpp explains
    kBudget,  ///< stopped after the given number of insertions; call again
    kFull,    ///< the mesh has reached the limit on triangles or on points
  };
  /// Refines until all is done or about `insertions` points have been inserted.
  Status refine(std::int64_t insertions);
  Status refine() { return refine(INT64_MAX); }

  /// Stop at this many live triangles (kFull). Default: the capacity of the handles.
  void limit_triangles(std::int64_t most) { state_.max_triangles = std::min(most, kMostRefined); }

  /// See Improver.
  bool add_split_point(RootId root, dyadic::Path path);
  using Improver::counters;
  using Improver::take_split_points;

  [[nodiscard]] const RefinerState& state() const { return state_; }
  /// Continues from a state. Throws Error like the other constructor, and if the state has a fault.
  Refiner(Triangulation& mesh, const QualityBounds& bounds, RefinerState state)
      : Refiner(mesh, bounds.min_angle, bounds, std::move(state)) {}

 private:
  Refiner(Triangulation& mesh, double min_angle, const SizeBounds& sizes, RefinerState state);
  friend Improver;
  using Stage = RefinerState::Stage;

  [[nodiscard]] CornerPoints corners(TriangleId t) const {
    return {mesh_.corner(t, 0), mesh_.corner(t, 1), mesh_.corner(t, 2)};
  }
  [[nodiscard]] bool is_large(TriangleId t, double twice_area) const;
  [[nodiscard]] bool is_large_for_size(TriangleId t, double twice_area) const;
  [[nodiscard]] double twice_area_bound(TriangleId t) const;
  [[nodiscard]] bool looks_between() const;
  void look_between();
  bool step();
  bool step_segments();
  [[nodiscard]] bool is_full() const;
  [[nodiscard]] bool is_encroached(SubsegmentId s) const;
  bool split_encroached();
  Progress improve_large(TriangleId t);
  void fetch_surroundings(TriangleId t) const;
  bool step_large();
  bool step_skinny();
  void enter(Stage stage);
  [[nodiscard]] bool wants_coarse_stage() const;

  void note_fresh();
  void note(TriangleId t, const Shape& s);
  void note_skinny(TriangleId t, const Shape& s);

  std::int64_t given_points_ = static_cast<std::int64_t>(mesh_.live_vertices());  // before refinement
  double coarsening_ = 1;                                                         // current factor on all area bounds
};

}  // namespace driftmesh
