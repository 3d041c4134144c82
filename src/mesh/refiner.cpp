#include "mesh/refiner.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/triangle_geometry.hpp"
#include "mesh/bound_forecast.hpp"
#include "mesh/exceptions.hpp"
#include "mesh/renumber.hpp"
#include "mesh/thinning.hpp"

namespace driftmesh {
namespace {

/// The number of triangles of the finished mesh that come from one triangle of the coarse stage, and from one block. A
/// block with its vertices (32 bytes per triangle) fits in a second-level cache.
constexpr double kFinePerCoarse = 256;
constexpr double kFinePerBlock = 65536;

constexpr std::int32_t kFetchAhead = 6;  // slots, see fetch_surroundings

}  // namespace

Refiner::Refiner(Triangulation& mesh, double min_angle, const SizeBounds& sizes, RefinerState state)
    : Improver(mesh, min_angle, sizes, std::move(state)) {
  coarsening_ = state_.stage == Stage::kCoarse ? kFinePerCoarse : 1;
  if (state_.stage == Stage::kDone) cavity_.rest();
  if (state_.sweep.ended()) cavity_.begin_by_place();
}

// ---- Bounds ----

/// Whether a triangle with twice this area is too large.
inline bool Refiner::is_large(TriangleId t, double twice_area) const {
  return (twice_area > coarsening_ * areas_.constant(t) || (areas_.by_place() && is_large_for_size(t, twice_area))) &&
         !areas_.sizes().spares(corners(t), twice_area);
}

bool Refiner::is_large_for_size(TriangleId t, double twice_area) const {
  const auto& v = mesh_.triangles[t].vertex;
  const auto at_corners = [&] { return std::min({state_.size[v[0]], state_.size[v[1]], state_.size[v[2]]}); };
  return areas_.above_size(corners(t), twice_area / coarsening_, at_corners, looks_between());
}

/// The bound on twice the area of a triangle that is not too large.
double Refiner::twice_area_bound(TriangleId t) const {
  double bound = coarsening_ * areas_.constant(t);
  if (!areas_.by_place()) return bound;
  const auto limit = [&](double h) { bound = std::min(bound, twice_area_of_edge(h) * coarsening_); };
  for (const VertexId v : mesh_.triangles[t].vertex) limit(state_.size[v]);
  limit(areas_.sizes().length_at(centroid(corners(t))));
  return bound;
}

/// Most triangles of the fine stage are to disappear again. What would be missed by far is found in the coarse stage,
/// and the rest by look_between.
bool Refiner::looks_between() const {
  return state_.stage != Stage::kSegments && state_.stage != Stage::kFine;
}

/// Makes up for what the fine stage has not looked at.
void Refiner::look_between() {
  if (!areas_.by_place()) return;
  for (const TriangleId t : ids_of(mesh_.triangles))
    if (mesh_.triangles[t].alive() && is_large_for_size(t, twice_area(t))) state_.sweep.visit_again(t);
}

// ---- The order of work ----

Refiner::Status Refiner::refine(std::int64_t insertions) {
  const auto inserted = [this] { return state_.counters.free_points + state_.counters.segment_points; };
  const std::int64_t stop = insertions > INT64_MAX - inserted() ? INT64_MAX : inserted() + insertions;
  while (inserted() < stop) {
    if (is_full()) return Status::kFull;
    if (!step()) return Status::kDone;
  }
  return Status::kBudget;
}

bool Refiner::is_full() const {
  const auto points = [this] { return static_cast<std::int64_t>(mesh_.live_vertices()) - given_points_; };
  return (static_cast<std::int64_t>(mesh_.triangles.size()) >= state_.max_triangles &&
          static_cast<std::int64_t>(mesh_.live_triangles()) >= state_.max_triangles) ||
         (rules_.most_points != INT64_MAX && points() >= rules_.most_points);
}

/// One attempt at one triangle or segment; false when all is done.
bool Refiner::step() {
  switch (state_.stage) {
    case Stage::kSegments:
      if (!step_segments()) enter(wants_coarse_stage() ? Stage::kCoarse : Stage::kFine);
      return true;
    case Stage::kCoarse:
      if (!step_large() && !state_.sweep.next_block()) enter(Stage::kFine);
      return true;
    case Stage::kFine:
      if (!step_large() && !step_skinny() && !state_.sweep.next_block()) {
        enter(Stage::kRest);
        look_between();
      }
      return true;
    case Stage::kRest:
      if (step_large() || step_skinny() || (rules_.conforming && split_encroached())) return true;
      state_.counters.deleted_points += thin_for_step(mesh_, min_angle_, areas_);
      enter(Stage::kDone);
      return true;
    case Stage::kDone:
      break;
  }
  return false;
}

void Refiner::enter(Stage stage) {
  const auto size = [this] { return to_int(mesh_.triangles.next_id()); };
  state_.stage = stage;
  switch (stage) {
    case Stage::kCoarse:
      coarsening_ = kFinePerCoarse;
      state_.sweep.start(size(), size());
      break;
    case Stage::kFine: {
      const bool after_coarse = coarsening_ != 1;
      coarsening_ = 1;
      if (after_coarse) renumber(mesh_, GivenVertices::kFirst);
      if (after_coarse && areas_.by_place())
        for (const VertexId v : ids_of(mesh_.points)) state_.size[v] = areas_.sizes().length_at(mesh_.points[v]);
      state_.sweep.start(size(), after_coarse ? static_cast<std::int32_t>(kFinePerBlock / kFinePerCoarse) : size());
      state_.skinny.clear();
      break;
    }
    case Stage::kRest:
      cavity_.wake();
      for (const TriangleId t : state_.deferred)
        if (mesh_.triangles[t].alive()) note(t, shape_of(t));
      state_.deferred.clear();
      break;
    case Stage::kDone:  // most refiners are done for most of a run; keep them small
      state_.skinny.clear();
      state_.sweep.end();
      changed_ = {};
      cavity_.begin_by_place();
      cavity_.rest();
      break;
    case Stage::kSegments:
      break;
  }
}

/// Whether the finished mesh will outgrow the cache by far, so that it pays to refine it block by block.
bool Refiner::wants_coarse_stage() const {
  const double large = std::max(4 * kFinePerBlock, kFinePerCoarse / 4 * static_cast<double>(mesh_.live_triangles()));
  if (most_in_total(mesh_, areas_.sizes()) <= large) return false;  // such as nearly all subdomains
  return BoundForecast(mesh_, areas_.sizes()).total() > large;
}

/// Splits the next given segment if its lens holds a vertex from the start. Done before anything else, this saves
/// triangles where angles are bounded; otherwise a segment stays whole until a point encroaches upon it.
bool Refiner::step_segments() {
  if (min_angle_ == 0 || state_.next_segment == mesh_.subsegments.next_id()) return false;
  const Subsegment& s = mesh_.subsegments[state_.next_segment];
  if (s.is_leaf()) {
    const Point &a = mesh_.points[s.vertex[0]], &b = mesh_.points[s.vertex[1]];
    const double cosine = -std::sqrt(lens_.cos_squared);
    for (const HalfEdge h : s.half)
      if (h != kNone && in_diametral_lens(mesh_.points[mesh_.apex(h)], a, b, cosine)) {
        split_and_tell(state_.next_segment);
        break;
      }
  }
  state_.next_segment = after(state_.next_segment);
  return true;
}

bool Refiner::is_encroached(SubsegmentId s) const {
  const Subsegment& segment = mesh_.subsegments[s];
  if (!segment.is_leaf()) return false;
  const auto [a, b] = segment.vertex;
  return std::ranges::any_of(segment.half, [&, a = a, b = b](HalfEdge h) {
    if (h == kNone) return false;
    const VertexId apex = mesh_.apex(h);
    return in_diametral_lens(mesh_.points[apex], mesh_.points[a], mesh_.points[b], 0) &&
           !on_same_shell(mesh_, apex, a) && !on_same_shell(mesh_, apex, b);
  });
}

/// Splits segments until none has a vertex in its diametral circle, or the mesh is full. Whether any was split.
bool Refiner::split_encroached() {
  bool any = false;
  for (bool changed = true; changed;) {
    changed = false;
    for (SubsegmentId s{0}; s != mesh_.subsegments.next_id() && !is_full(); s = after(s))
      if (is_encroached(s) && split_and_tell(s)) any = changed = true;
  }
  return any;
}

/// Where the circumcenter would split a segment that must stay whole, the centroid makes the triangle smaller.
Refiner::Progress Refiner::improve_large(TriangleId t) {
  const Progress progress = improve(t, circumcenter_of(t));
  if (progress == Progress::kChanged || rules_.split == InsertionRules::Split::kEverywhere) return progress;
  return insert_inside(t, centroid(corners(t)));
}

/// Has the processor fetch what an insertion into the triangle in slot t would read first. The sweep knows some slots
/// ahead where it will go, and the insertions in between give memory the time to answer. Always inlined, since gcc
/// drops calls of a function that does nothing but prefetch.
[[gnu::always_inline]] inline void Refiner::fetch_surroundings(TriangleId t) const {
  if (!mesh_.triangles.has(t) || !mesh_.triangles[t].alive()) return;
  const Triangle& triangle = mesh_.triangles[t];
  for (const VertexId v : triangle.vertex) __builtin_prefetch(&mesh_.points[v]);
  for (const HalfEdge h : triangle.neighbor)
    if (!is_constrained(h)) __builtin_prefetch(&mesh_.triangles[triangle_of(h)]);
}

/// Sweeps on to the next triangle that is too large, and inserts its circumcenter. False at the end of the block.
bool Refiner::step_large() {
  for (;;) {
    const TriangleId t = state_.sweep.current(to_int(mesh_.triangles.next_id()));
    if (t == kNone) return false;
    fetch_surroundings(TriangleId{to_int(t) + kFetchAhead});
    if (mesh_.triangles[t].alive()) [[likely]] {
      const double twice = twice_area(t);
      if (is_large(t, twice)) {
        if (improve_large(t) == Progress::kChanged) return true;
        ++state_.counters.given_up;
      } else if (state_.stage != Stage::kCoarse) {
        const Shape s = shape_of(t, twice);
        if (is_skinny(s)) note_skinny(t, s);
      }
    }
    state_.sweep.done_with(t);
  }
}

bool Refiner::step_skinny() {
  const SkinnyBuckets::Entry entry = state_.skinny.take();
  const TriangleId t = entry.triangle;
  if (t == kNone) return false;
  if (!mesh_.triangles[t].alive()) return true;
  const Shape s = shape_of(t);
  if (!is_skinny(s) || !entry.fits(s.shortest)) return true;
  if (cause_of(mesh_, t) != ExceptionCause::kUnexplained) return true;
  const std::int64_t before = state_.counters.free_points;
  if (improve(t, off_center_of(t)) == Progress::kStuck)
    ++state_.counters.given_up;
  else if (state_.counters.free_points == before)
    state_.skinny.add(t, entry.bucket);  // a segment was split instead: the triangle may still be there
  return true;
}

// ---- What has changed ----

bool Refiner::add_split_point(RootId root, dyadic::Path path) {
  if (state_.stage == Stage::kDone && mesh_.subsegments[mesh_.descend(root, path)].is_leaf()) enter(Stage::kRest);
  return Improver::add_split_point(root, path);
}

void Refiner::note_fresh() {
  const int n = cavity_.fresh_count();
  for (int i = 0; i < n; ++i) {
    if (state_.sweep.will_visit(cavity_.fresh_triangle(i))) continue;
    const Cavity::Fresh f = cavity_.fresh(i);
    note(f.triangle, shape(f.twice_area, f.ab, f.bc, f.ca));
  }
}

/// Queues a triangle that needs work, unless the sweep will come to it anyway.
inline void Refiner::note(TriangleId t, const Shape& s) {
  if (state_.sweep.will_visit(t)) return;
  if (is_large(t, s.twice_area))
    state_.sweep.visit_again(t);
  else if (state_.stage != Stage::kCoarse && is_skinny(s))
    note_skinny(t, s);
}

/// A long skinny triangle at the border of the current block reaches into a block that is still coarse. It will
/// disappear when that block is refined, so it waits for the end.
inline void Refiner::note_skinny(TriangleId t, const Shape& s) {
  if (state_.stage == Stage::kFine && s.longest > 8 * twice_area_bound(t))
    state_.deferred.push_back(t);
  else
    state_.skinny.add(t, SkinnyBuckets::bucket_of(s.shortest));
}

}  // namespace driftmesh
