#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "mesh/mesh_piece.hpp"
#include "pslg/pslg.hpp"
#include "sizing/size_field.hpp"
#include "verify/findings.hpp"
#include "verify/quality.hpp"

namespace driftmesh {

struct VerifyOptions {
  double min_angle = 0;             ///< degrees; 0: no bound
  double max_area = 0;              ///< 0: no bound beside those of the regions
  bool region_areas = true;         ///< the input's regions bound the areas of their triangles
  const SizeField* size = nullptr;  ///< target edge lengths that bound areas, or null; not owned
  bool check_delaunay = true;       ///< false for meshes that only need to be conforming
  std::size_t max_listed = 5;       ///< messages kept of each kind of flaw and of each cause of an exception
};

/// Everything that was checked and measured.
struct VerifyReport {
  std::size_t points = 0;
  std::size_t unused_points = 0;  ///< no flaw: Triangle's files may hold them
  std::size_t triangles = 0;
  std::size_t subsegments = 0;
  std::size_t boundary_edges = 0;
  bool subsegments_listed = true;  ///< false: the piece lists none, and its boundary was taken as constrained
  bool regions_listed = true;      ///< false: the input has regions, and the piece does not say which triangle is where
  std::size_t pieces = 0;          ///< that the mesh came in; 0: one file
  std::size_t subdomains = 0;      ///< 0: not told by the mesh
  std::size_t interfaces = 0;      ///< pairs of subdomains with a common edge that is no subsegment
  std::size_t interface_edges = 0;  ///< these edges: they need not be Delaunay
  std::size_t interface_edges_not_delaunay = 0;
  std::size_t rank_interface_edges = 0;  ///< of these edges: between different ranks
  double area = 0;
  bool against_input = false;
  double input_area = 0;  ///< of the domain that the input describes, if against_input
  Quality quality;
  Findings findings;

  [[nodiscard]] bool accepted() const { return findings.empty(); }
};

/// Checks a finished mesh without knowing how it was made (exact predicates are all it shares with the mesher):
/// - it is a triangulation: every triangle counterclockwise, edges shared by two triangles or subsegments of the
///   boundary, the boundary free of self-intersections. Together these prove that no point of the plane is covered
///   twice: the number of triangles over a point is the winding number of the boundary around it.
/// - it is constrained Delaunay: no point opposite an unconstrained edge lies inside the circumcircle. Local Delaunay
///   at every such edge implies it everywhere (Chew 1989).
///   Edges between triangles of different subdomains (MeshPiece::subdomains) count as constrained for that.
/// - with bounds given, areas and angles keep them; see ExceptionReason for those that may not.
/// About 55 bytes a triangle beside the mesh. Throws LimitError above 1.4 billion triangles.
[[nodiscard]] VerifyReport verify(const MeshPiece& mesh, const VerifyOptions& options);

/// Also checks the mesh against its input: `input` is planar (as repair leaves it), its exterior and holes are carved.
/// - the domain is what an arrangement of the input segments says (no triangulation is involved): its boundary is the
///   boundary of the mesh, so every point of it is covered once and no other;
/// - every input segment in the domain is one chain of subsegments with its marker, in order along it and on it up to
///   the rounding of repeated midpoints; there are no other subsegments;
/// - every input point in the domain is a vertex; area, Euler number and region attributes (if listed) agree.
/// An input without segments describes the convex hull of its points, with marker 1 all around.
[[nodiscard]] VerifyReport verify(const MeshPiece& mesh, const Pslg& input, const VerifyOptions& options);

/// The same of a mesh in pieces, and that the pieces fit: points with the same number have the same coordinates, marker
/// and attributes to the last bit wherever they are, and all numbers from 0 on are there. Both sides of every interface
/// then have the same points and edges if the whole passes the checks above, where points of the same place with
/// different numbers and edges with one triangle are flaws. `input` may be null. Throws Error if pieces have no
/// numbers.
[[nodiscard]] VerifyReport verify_pieces(std::span<const MeshPiece> pieces, const Pslg* input,
                                         const VerifyOptions& options);

}  // namespace driftmesh
