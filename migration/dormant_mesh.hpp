#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "decompose/subdomain_mesh.hpp"
#include "migration/triangle_code.hpp"

namespace driftmesh {

/// A finished subdomain's mesh in about 10 bytes a triangle, of which 8 are the coordinates of free vertices: what it
/// shrinks to until somebody needs it. Triangles are a code of a byte each (triangle_code.hpp); points on segments are
/// the shape of their root's tree, two bits each, since their coordinates follow from it; what was given (corners,
/// roots) is kept as numbers of few bytes.
///
/// Vertices are numbered anew: given ones in their order, then those on segments, root by root and each after its
/// parent, then the free ones. Slots, and with them the order in which refinement goes on, are not kept; the mesh is:
/// triangles, constrained edges with roots and paths, regions, origins, to the last bit.
class DormantMesh {
 public:
  DormantMesh() = default;
  /// Throws Error if triangles cannot be reached from the border (a sound mesh has none).
  explicit DormantMesh(const SubdomainMesh& part);

  [[nodiscard]] std::int32_t triangles() const { return triangles_.triangles; }
  [[nodiscard]] std::int32_t vertices() const { return triangles_.vertices; }
  [[nodiscard]] std::size_t bytes() const;  ///< of memory, all of it

  /// Whether the point is there: needs no mesh. `root` counts the subdomain's own.
  [[nodiscard]] bool holds(RootId root, dyadic::Path path) const;
  /// The mesh without its triangles and free vertices: roots with their trees, numbers, given points.
  [[nodiscard]] SubdomainMesh skeleton() const { return frame().part; }
  /// All points, by vertex.
  [[nodiscard]] std::vector<Point> points() const;
  /// Calls visit(corners counterclockwise, region label) for each triangle: for output, digests and statistics, without
  /// a triangulation.
  template <class Visit>
  void visit_triangles(Visit&& visit) const {
    decode_triangles(triangles_, border(), visit);
  }

  /// For a form that came from elsewhere: throws Error if the rest of this class could not go by it.
  void check() const;
  /// The mesh again. Throws Error if this is not what the constructor made of a sound mesh.
  [[nodiscard]] SubdomainMesh wake() const;
  /// What subsegment s of the mesh that was given to the constructor is in the mesh that wakes.
  [[nodiscard]] static IdVector<SubsegmentId, SubsegmentId> waking_subsegments(const Triangulation& mesh);

  /// Calls transfer(field) for each field: to store and to load.
  template <class Self, class Transfer>
  static void fields(Self& self, Transfer&& transfer) {
    transfer(self.names_);
    transfer(self.trees_);
    transfer(self.given_);
    transfer(self.free_);
    transfer(self.triangles_.code);
    transfer(self.triangles_.triangles);
    transfer(self.triangles_.fixed);
    transfer(self.triangles_.vertices);
    transfer(self.has_regions_);
  }

 private:
  /// Roots, numbers and origins, read from names_ and trees_.
  struct Frame {
    SubdomainMesh part;                    // without triangles and free vertices
    IdVector<RootId, std::uint8_t> sides;  // of each root: bit 0 if the domain lies left of it, bit 1 if right
  };
  [[nodiscard]] Frame frame() const;
  void check_counts(const Frame& frame) const;
  [[nodiscard]] std::vector<BorderEdge> border() const { return border_of(frame()); }
  [[nodiscard]] static std::vector<BorderEdge> border_of(const Frame& frame);

  Bytes names_;               // given vertices, root and point numbers
  Bytes trees_;               // of each root: its nodes, parents first, a bit each: 1 if cut
  std::vector<Point> given_;  // coordinates of given vertices
  std::vector<Point> free_;   // and of free ones, as the walk meets them
  CodedTriangles triangles_;
  std::uint8_t has_regions_ = 0;
};

}  // namespace driftmesh
