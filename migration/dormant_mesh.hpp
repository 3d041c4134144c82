#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "decompose/subdomain_mesh.hpp"
#include "migration/triangle_code.hpp"

namespace driftmesh {

/// A finished subdomain's mesh in about 10 bytes per triangle, 8 of which are the coordinates of free vertices: the
/// compressed form until it is needed again. Triangles are coded in one byte each (triangle_code.hpp); points on
/// segments are given by the shape of their root's tree, two bits each, since their coordinates follow from it; given
/// data (corners, roots) are stored as numbers of a few bytes. Vertices are renumbered: given ones in their order, then
/// those on segments, root by root and each after its parent, then the free ones. The mesh is preserved to the last
/// bit: triangles, constrained edges with roots and paths, regions, origins. Slots are not: waking puts everything into
/// one canonical order, which depends on the mesh alone and not on how its slots came about.
class DormantMesh {
 public:
  DormantMesh() = default;
  /// Throws Error if triangles cannot be reached from the border (impossible in a valid mesh).
  explicit DormantMesh(const SubdomainMesh& part);

  [[nodiscard]] std::int32_t triangles() const { return triangles_.triangles; }
  [[nodiscard]] std::int32_t vertices() const { return triangles_.vertices; }
  [[nodiscard]] std::size_t bytes() const;  ///< all the memory it takes

  /// Nearly all of the bytes. What remains without them says which points exist, and how many triangles.
  struct Bulk {
    std::vector<Point> free;
    Bytes code;
  };
  /// Until give() only triangles(), vertices(), holds() and skeleton() may be called.
  [[nodiscard]] Bulk take() { return {std::exchange(free_, {}), std::exchange(triangles_.code, {})}; }
  void give(Bulk bulk);

  /// Whether the point exists, without waking the mesh. `root` is local to the subdomain.
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

  /// For a form from elsewhere: throws Error if it is not usable by the rest of this class.
  void check() const;
  /// Restores the mesh. Throws Error if this is not what the constructor makes of a valid mesh.
  [[nodiscard]] SubdomainMesh wake() const;
  /// The subsegment of the restored mesh that corresponds to subsegment s of the constructor's mesh.
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
    IdVector<RootId, std::uint8_t> sides;  // for each root, bit 0 if the domain lies left of it, bit 1 if right
  };
  [[nodiscard]] Frame frame() const;
  void check_counts(const Frame& frame) const;
  [[nodiscard]] std::vector<BorderEdge> border() const { return border_of(frame()); }
  [[nodiscard]] static std::vector<BorderEdge> border_of(const Frame& frame);

  Bytes names_;               // given vertices, root and point numbers
  Bytes trees_;               // for each root its nodes, parents first, one bit each: 1 if split
  std::vector<Point> given_;  // coordinates of given vertices
  std::vector<Point> free_;   // coordinates of free vertices, as the walk meets them
  CodedTriangles triangles_;
  std::uint8_t has_regions_ = 0;
};

}  // namespace driftmesh
