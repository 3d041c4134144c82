#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "base/growing_array.hpp"
#include "base/mix.hpp"
#include "dyadic/path.hpp"
#include "mesh/improver.hpp"
#include "study/pdr/lattice.hpp"

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
class CellRefiner : private Improver<CellRefiner> {
 public:
  /// `mesh` and `lattice` outlive the object.
  CellRefiner(Triangulation& mesh, const QualityBounds& bounds, const Lattice& lattice);

  /// The cell to which a triangle belongs: that of its leftmost corner. Free of rounding, so ranks agree.
  [[nodiscard]] Cell cell_of(TriangleId t) const;

  /// Refines the cells of `rank` in this color until their triangles meet the bounds, and returns what was done in each
  /// cell. Throws Error if a change reaches farther than half a side beyond its cell.
  [[nodiscard]] std::map<Cell, std::vector<Change>> refine(Rank rank, int color);
  /// Repeats changes that another rank has made to cells, in their order.
  void repeat(std::span<const Change> changes);

  /// Counts what this rank has refined, without what it has repeated.
  [[nodiscard]] const RefineCounters& own_counters() const { return own_; }
  /// Counts what it has repeated, too.
  using Improver::counters;

 private:
  friend Improver;
  /// By exact coordinates. 0 and -0 are equal, so they hash alike.
  struct PointHash {
    std::size_t operator()(const Point& p) const {
      return mix(mix(std::bit_cast<std::uint64_t>(p.x + 0.0)) ^ std::bit_cast<std::uint64_t>(p.y + 0.0));
    }
  };
  using VertexAt = std::unordered_map<Point, VertexId, PointHash>;

  void note_fresh() {
    for (int i = 0; i < cavity_.fresh_count(); ++i) touched_.push_back(cavity_.fresh_triangle(i));
  }
  void note(TriangleId t, const Shape& /*shape*/) { touched_.push_back(t); }
  [[nodiscard]] std::optional<Point> wanted(TriangleId t) const;
  void sort_changed(Rank rank);
  [[nodiscard]] std::vector<Change> refine_cell(Cell cell, const std::vector<TriangleId>& work);
  void check_reach(Cell cell) const;
  [[nodiscard]] VertexAt find_vertices(std::span<const Change> changes) const;
  void repeat(const Change& change, VertexAt& vertex_at);
  [[nodiscard]] TriangleId left_of(VertexId from, const Point& to) const;
  /// Does visit(t, v) for each corner v of each triangle t that the last change has touched.
  template <class Visit>
  void each_touched_corner(const Visit& visit) const {
    for (const TriangleId t : touched_)
      if (mesh_.triangles[t].alive())
        for (const VertexId v : mesh_.triangles[t].vertex) visit(t, v);
  }
  void take_touched();

  const Lattice& lattice_;
  RefineCounters own_;
  std::vector<TriangleId> touched_;                               ///< by the last change; some may be dead
  std::vector<TriangleId> changed_since_;                         ///< since they were last sorted by color; may repeat
  std::array<std::vector<TriangleId>, Lattice::kColors> unseen_;  ///< those that a color has to look at
  GrowingArray<TriangleId, VertexId> incident_;                   ///< a triangle at each vertex
};

}  // namespace driftmesh::pdr
