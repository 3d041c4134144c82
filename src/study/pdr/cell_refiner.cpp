#include "study/pdr/cell_refiner.hpp"

#include <algorithm>
#include <deque>
#include <utility>

#include "driftmesh/error.hpp"
#include "mesh/exceptions.hpp"

namespace driftmesh::pdr {

CellRefiner::CellRefiner(Triangulation& mesh, const QualityBounds& bounds, const Lattice& lattice)
    : Improver(mesh, bounds.min_angle, bounds, {}), lattice_(lattice) {
  for (const TriangleId t : ids_of(mesh.triangles)) touched_.push_back(t);
  take_touched();
}

Cell CellRefiner::cell_of(TriangleId t) const {
  const auto leftmost = [](const Point& a, const Point& b) { return std::pair(a.x, a.y) < std::pair(b.x, b.y); };
  return lattice_.cell_of(std::min({mesh_.corner(t, 0), mesh_.corner(t, 1), mesh_.corner(t, 2)}, leftmost));
}

/// Notes a triangle for each corner of those that were touched, and that somebody must look at them.
void CellRefiner::take_touched() {
  if (incident_.size() < mesh_.points.size()) incident_.resize(mesh_.points.size(), kNone);
  each_touched_corner([&](TriangleId t, VertexId v) { incident_[v] = t; });
  changed_since_.insert(changed_since_.end(), touched_.begin(), touched_.end());
}

// ---- Refining ----

/// A point that would improve triangle t; nothing if it meets the bounds, or exceptions.hpp explains it.
std::optional<Point> CellRefiner::wanted(TriangleId t) const {
  const Shape s = shape_of(t);
  if (s.twice_area > areas_.constant(t)) return circumcenter_of(t);
  if (!is_skinny(s) || cause_of(mesh_, t) != ExceptionCause::kUnexplained) return std::nullopt;
  return off_center_of(t);
}

/// So that a turn takes time for what has changed, not for the whole mesh.
void CellRefiner::sort_changed(Rank rank) {
  std::sort(changed_since_.begin(), changed_since_.end());
  changed_since_.erase(std::unique(changed_since_.begin(), changed_since_.end()), changed_since_.end());
  for (const TriangleId t : changed_since_)
    if (mesh_.triangles[t].alive() && wanted(t))
      if (const Cell cell = cell_of(t); lattice_.owner_of(cell) == rank) unseen_[Lattice::color_of(cell)].push_back(t);
  changed_since_.clear();
}

std::map<Cell, std::vector<Change>> CellRefiner::refine(Rank rank, int color) {
  const RefineCounters before = counters();
  sort_changed(rank);
  std::map<Cell, std::vector<TriangleId>> work;
  for (const TriangleId t : std::exchange(unseen_[color], {}))
    if (mesh_.triangles[t].alive())
      if (const Cell cell = cell_of(t); Lattice::color_of(cell) == color && lattice_.owner_of(cell) == rank)
        work[cell].push_back(t);
  std::map<Cell, std::vector<Change>> all;
  for (const auto& [cell, triangles] : work)
    if (auto changes = refine_cell(cell, triangles); !changes.empty()) all[cell] = std::move(changes);
  for (const auto count : {&RefineCounters::free_points, &RefineCounters::segment_points,
                           &RefineCounters::deleted_points, &RefineCounters::encroaching})
    own_.*count += counters().*count - before.*count;
  return all;
}

std::vector<Change> CellRefiner::refine_cell(Cell cell, const std::vector<TriangleId>& work) {
  std::vector<Change> changes;
  std::deque<TriangleId> queue(work.begin(), work.end());
  for (; !queue.empty(); queue.pop_front()) {
    const TriangleId t = queue.front();
    if (!mesh_.triangles[t].alive() || cell_of(t) != cell) continue;
    const auto p = wanted(t);
    if (!p) continue;
    const Change free{kNone, 0, *p, mesh_.corner(t, 0), mesh_.corner(t, 1)};
    touched_.clear();
    if (improve(t, *p) == Progress::kStuck) continue;
    check_reach(cell);
    const auto splits = take_split_points();
    if (splits.empty()) changes.push_back(free);
    for (const auto& split : splits) changes.push_back({split.root, split.path, {}, {}, {}});
    take_touched();
    queue.insert(queue.end(), touched_.begin(), touched_.end());
    if (!splits.empty()) queue.push_back(t);  // it may still be there
  }
  return changes;
}

void CellRefiner::check_reach(Cell cell) const {
  each_touched_corner([&](TriangleId, VertexId v) {
    if (!lattice_.is_near(cell, mesh_.points[v]))
      throw Error("the cells of the lattice are too small: a change reaches beyond half a cell; use another method");
  });
}

// ---- Repeating ----

void CellRefiner::repeat(std::span<const Change> changes) {
  VertexAt vertex_at = find_vertices(changes);
  for (const Change& change : changes) repeat(change, vertex_at);
  static_cast<void>(take_split_points());
}

/// The vertices from which changes start, as far as there are any yet.
CellRefiner::VertexAt CellRefiner::find_vertices(std::span<const Change> changes) const {
  VertexAt found;
  for (const Change& change : changes)
    if (change.root == kNone) found.emplace(change.from, kNone);
  if (found.empty()) return found;
  for (const VertexId v : ids_of(mesh_.points))
    if (mesh_.origin[v] != kDeleted)
      if (const auto at = found.find(mesh_.points[v]); at != found.end()) at->second = v;
  return found;
}

/// Far from this rank's block its mesh is coarser than the sender's, and a change may not fit; there it does not
/// matter.
void CellRefiner::repeat(const Change& change, VertexAt& vertex_at) {
  touched_.clear();
  if (change.root != kNone) {
    static_cast<void>(add_split_point(change.root, change.path));
  } else {
    const VertexId from = vertex_at.at(change.from);
    if (from == kNone || mesh_.origin[from] == kDeleted || mesh_.points[from] != change.from) return;
    static_cast<void>(improve(left_of(from, change.to), change.point));
  }
  take_touched();
  each_touched_corner([&](TriangleId, VertexId v) {
    if (const auto at = vertex_at.find(mesh_.points[v]); at != vertex_at.end()) at->second = v;
  });
}

/// The triangle on the left of the edge between two vertices; if there is no such edge, any at the first.
TriangleId CellRefiner::left_of(VertexId from, const Point& to) const {
  const TriangleId start = incident_[from];
  for (const bool clockwise : {false, true})
    for (TriangleId t = start;;) {
      const auto& v = mesh_.triangles[t].vertex;
      const int i = v[0] == from ? 0 : v[1] == from ? 1 : 2;
      if (mesh_.points[v[next(i)]] == to) return t;
      const HalfEdge h = mesh_.across(half_edge(t, clockwise ? previous(i) : next(i)));
      if (h == kNone || triangle_of(h) == start) break;
      t = triangle_of(h);
    }
  return start;
}

}  // namespace driftmesh::pdr
