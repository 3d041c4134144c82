#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "base/growing_array.hpp"
#include "dyadic/path.hpp"
#include "mesh/refiner.hpp"
#include "study/pdr/lattice.hpp"
#include "study/pdr/point_hash.hpp"

namespace driftmesh::pdr {

/// One change of a mesh, for ranks that have the same triangles there: a point on a segment, or in the circumdisk of
/// the triangle on the left of an edge.
struct Change {
  RootId root = kNone;  ///< kNone for a free point
  dyadic::Path path = 0;
  Point point;     ///< the free point
  Point from, to;  ///< the edge
};

/// A rank's view of the common mesh: complete in its block of cells and around it, coarse elsewhere.
class CellRefiner {
 public:
  /// `mesh` and `lattice` outlive the object.
  CellRefiner(Triangulation& mesh, const QualityBounds& bounds, const Lattice& lattice);

  /// The cell to which a triangle belongs: that of its leftmost corner. Free of rounding, so ranks agree.
  [[nodiscard]] Cell cell_of(TriangleId t) const;

  struct Changes {
    Cell cell;
    std::vector<Change> list;
  };
  /// Refines the cells of `rank` in this color until their triangles meet the bounds, and returns what was done, cell
  /// by cell. Throws Error if a change reaches farther than half a side beyond its cell.
  [[nodiscard]] std::vector<Changes> refine(Rank rank, int color);
  /// Repeats changes that another rank has made to cells, in their order.
  void repeat(std::span<const Change> changes);

  /// Counts what this rank has refined, without what it has repeated.
  [[nodiscard]] const RefineCounters& counters() const { return own_; }
  /// Counts what it has repeated, too.
  [[nodiscard]] const RefineCounters& all_counters() const { return refiner_.counters(); }

 private:
  using VertexAt = std::unordered_map<Point, VertexId, PointHash>;

  void sort_changed(Rank rank);
  [[nodiscard]] Changes refine_cell(Cell cell, std::vector<TriangleId> work);
  void check_reach(Cell cell) const;
  [[nodiscard]] VertexAt find_vertices(std::span<const Change> changes) const;
  void repeat(const Change& change, VertexAt& vertex_at);
  [[nodiscard]] TriangleId left_of(VertexId from, const Point& to) const;
  void note_touched();

  Triangulation& mesh_;
  const Lattice& lattice_;
  Refiner refiner_;
  RefineCounters own_;
  std::vector<TriangleId> touched_;
  std::vector<TriangleId> changed_;                               ///< since they were last sorted by color; may repeat
  std::array<std::vector<TriangleId>, Lattice::kColors> unseen_;  ///< those that a color has to look at
  GrowingArray<TriangleId, VertexId> incident_;                   ///< a triangle at each vertex
};

}  // namespace driftmesh::pdr
