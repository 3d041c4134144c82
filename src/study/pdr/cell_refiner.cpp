#include "study/pdr/cell_refiner.hpp"

#include <algorithm>
#include <deque>
#include <map>
#include <utility>

#include "driftmesh/error.hpp"

namespace driftmesh::pdr {

CellRefiner::CellRefiner(Triangulation& mesh, const QualityBounds& bounds, const Lattice& lattice)
    : mesh_(mesh), lattice_(lattice), refiner_(mesh, bounds) {
  refiner_.tell_changes(touched_);
  for (const TriangleId t : ids_of(mesh.triangles)) touched_.push_back(t);
  note_touched();
}

Cell CellRefiner::cell_of(TriangleId t) const {
  const auto leftmost = [](const Point& a, const Point& b) { return std::pair(a.x, a.y) < std::pair(b.x, b.y); };
  return lattice_.cell_of(std::min({mesh_.corner(t, 0), mesh_.corner(t, 1), mesh_.corner(t, 2)}, leftmost));
}

/// Notes a triangle for each corner of those that changed, and that somebody must look at them.
void CellRefiner::note_touched() {
  if (incident_.size() < mesh_.points.size()) incident_.resize(mesh_.points.size(), kNone);
  for (const TriangleId t : touched_)
    if (mesh_.triangles[t].alive())
      for (const VertexId v : mesh_.triangles[t].vertex) incident_[v] = t;
  changed_.insert(changed_.end(), touched_.begin(), touched_.end());
}

// ---- Refining ----

/// So that a turn takes time for what has changed, not for the whole mesh.
void CellRefiner::sort_changed(Rank rank) {
  std::sort(changed_.begin(), changed_.end());
  changed_.erase(std::unique(changed_.begin(), changed_.end()), changed_.end());
  for (const TriangleId t : changed_)
    if (mesh_.triangles[t].alive() && refiner_.wanted(t))
      if (const Cell cell = cell_of(t); lattice_.owner_of(cell) == rank) unseen_[Lattice::color_of(cell)].push_back(t);
  changed_.clear();
}

std::vector<CellRefiner::Changes> CellRefiner::refine(Rank rank, int color) {
  const RefineCounters before = refiner_.counters();
  sort_changed(rank);
  std::map<Cell, std::vector<TriangleId>> work;
  for (const TriangleId t : std::exchange(unseen_[color], {}))
    if (mesh_.triangles[t].alive())
      if (const Cell cell = cell_of(t); Lattice::color_of(cell) == color && lattice_.owner_of(cell) == rank)
        work[cell].push_back(t);
  std::vector<Changes> all;
  for (auto& [cell, triangles] : work)
    if (Changes changes = refine_cell(cell, std::move(triangles)); !changes.list.empty())
      all.push_back(std::move(changes));
  for (const auto count : {&RefineCounters::free_points, &RefineCounters::segment_points,
                           &RefineCounters::deleted_points, &RefineCounters::encroaching, &RefineCounters::given_up})
    own_.*count += refiner_.counters().*count - before.*count;
  return all;
}

CellRefiner::Changes CellRefiner::refine_cell(Cell cell, std::vector<TriangleId> work) {
  Changes changes{cell, {}};
  std::deque<TriangleId> queue(work.begin(), work.end());
  for (; !queue.empty(); queue.pop_front()) {
    const TriangleId t = queue.front();
    if (!mesh_.triangles[t].alive() || cell_of(t) != cell) continue;
    const auto p = refiner_.wanted(t);
    if (!p) continue;
    const Change free{kNone, 0, *p, mesh_.corner(t, 0), mesh_.corner(t, 1)};
    touched_.clear();
    if (!refiner_.insert(t, *p)) continue;
    check_reach(cell);
    const auto splits = refiner_.take_split_points();
    if (splits.empty()) changes.list.push_back(free);
    for (const auto& split : splits) changes.list.push_back({split.root, split.path, {}, {}, {}});
    note_touched();
    queue.insert(queue.end(), touched_.begin(), touched_.end());
    if (!splits.empty()) queue.push_back(t);  // it may still be there
  }
  return changes;
}

void CellRefiner::check_reach(Cell cell) const {
  for (const TriangleId t : touched_)
    if (mesh_.triangles[t].alive())
      for (const VertexId v : mesh_.triangles[t].vertex)
        if (!lattice_.is_near(cell, mesh_.points[v]))
          throw Error(
              "the cells of the lattice are too small: a change reaches beyond half a cell; use another method");
}

// ---- Repeating ----

void CellRefiner::repeat(std::span<const Change> changes) {
  VertexAt vertex_at = find_vertices(changes);
  for (const Change& change : changes) repeat(change, vertex_at);
  static_cast<void>(refiner_.take_split_points());
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
    static_cast<void>(refiner_.add_split_point(change.root, change.path));
  } else {
    const VertexId from = vertex_at.at(change.from);
    if (from == kNone || mesh_.origin[from] == kDeleted || mesh_.points[from] != change.from) return;
    static_cast<void>(refiner_.insert(left_of(from, change.to), change.point));
  }
  note_touched();
  for (const TriangleId t : touched_)
    if (mesh_.triangles[t].alive())
      for (const VertexId v : mesh_.triangles[t].vertex)
        if (const auto at = vertex_at.find(mesh_.points[v]); at != vertex_at.end()) at->second = v;
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
