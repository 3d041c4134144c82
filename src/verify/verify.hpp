#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>

#include "driftmesh/mesh.hpp"
#include "driftmesh/options.hpp"
#include "driftmesh/pslg.hpp"
#include "driftmesh/size_field.hpp"
#include "driftmesh/time_step.hpp"
#include "mesh/bounds.hpp"
#include "verify/across_check.hpp"
#include "verify/findings.hpp"
#include "verify/quality.hpp"
#include "verify/step_check.hpp"

namespace driftmesh {

/// The bounds that a mesh should meet, and what to report.
struct VerifyOptions {
  double min_angle = 0;             ///< degrees; 0: no bound
  PlainBounds plain{};              ///< areas are in squared units of the coordinates
  const SizeField* size = nullptr;  ///< target edge lengths that bound areas, or null; must outlive the call
  /// Inside large triangles the size is looked up four times in each square of this side; 0: at 16 points only.
  double size_spacing = 0;
  /// At corners and centroids, too, edges may be as much longer than the size as between them.
  bool size_is_compiled = false;
  AcrossRule across{};  ///< layers of triangles across channels; a mesh in pieces is joined for it
  /// The input before it was repaired, or null. If it consists of polygons, these are read anew, in the verifier's own
  /// way: what repair made of them must be the same up to rounding. Must outlive the call.
  const Pslg* given = nullptr;
  /// By how much repair may have moved the borders of polygons in `given`, where it was asked to: lengths within which
  /// points were joined or borders simplified. Areas then only agree within twice that along all borders.
  double moved = 0;
  HoleRule holes = HoleRule::kPoints;  ///< which parts of the input are holes
  bool check_delaunay = true;          ///< false for meshes that only need to be conforming
  /// The time step that triangles are to allow, and depths; null: none. Triangles above it are measured and listed;
  /// with `strict_step` they are flaws. It comes before `plain` and `size`: see StepCheck. Must outlive the call.
  CourantRule courant{};
  const Raster* depth = nullptr;
  bool strict_step = false;
  /// By how much a point may be inside the circumcircle of a triangle: for meshes from files that rounded their points.
  double delaunay_slack = 0;
  std::size_t max_listed = 5;  ///< messages kept of each kind of flaw and of each cause of an exception
  /// Pieces are spread over them, and most of the work on a mesh in one piece. With several, `size` is asked by several
  /// at once. The report does not depend on their number.
  std::size_t threads = 1;
};

/// Everything that was checked and measured.
struct VerifyReport {
  std::size_t points = 0;
  std::size_t unused_points = 0;  ///< points in no triangle; not a flaw, as Triangle's files may contain them
  std::size_t triangles = 0;
  std::size_t subsegments = 0;
  std::size_t boundary_edges = 0;
  bool subsegments_listed = true;   ///< false: the mesh lists none, so its boundary was taken as constrained
  bool regions_listed = true;       ///< false: the input has regions, but the mesh does not list them
  std::size_t pieces = 0;           ///< the mesh came in so many pieces; 0: in one file
  std::size_t subdomains = 0;       ///< 0: the mesh does not list them
  std::size_t interfaces = 0;       ///< pairs of subdomains with a common edge that is not a subsegment
  std::size_t interface_edges = 0;  ///< these edges, which need not be Delaunay
  std::size_t interface_edges_not_delaunay = 0;
  std::size_t rank_interface_edges = 0;  ///< those of these edges that lie between different ranks
  double area = 0;                       ///< sum over all triangles
  bool against_input = false;            ///< whether the mesh was checked against its input
  double input_area = 0;                 ///< if against_input: of the domain that the input describes
  bool polygons_judged = true;           ///< false: rounding keeps options.given from being read anew
  Quality quality;
  StepMeasures step;    ///< if options.depth is given
  AcrossReport across;  ///< if it was asked for
  Findings findings;

  /// Whether no flaw was found. Exceptions (quality.exceptions) are not flaws.
  [[nodiscard]] bool accepted() const { return findings.empty(); }
};

/// Checks a finished mesh independently of how it was made (it shares only the exact predicates with the mesher):
/// - it is a triangulation: every triangle is counterclockwise, every edge belongs to two triangles or is a subsegment
///   of the boundary, and the boundary does not intersect itself. Together these prove that no point of the plane is
///   covered twice, since the number of triangles over a point is the winding number of the boundary around it;
/// - it is constrained Delaunay: no point opposite an unconstrained edge lies inside the circumcircle. If this holds at
///   every such edge, it holds everywhere (Chew 1989). Edges between triangles of different subdomains
///   (Mesh::subdomains) count as constrained here;
/// - areas and angles meet the bounds of `options`; see ExceptionReason for accepted exceptions, and SizeCheck for what
///   a size field asks for;
/// - channels have as many layers of triangles as options.across asks for, if so: see check_across.
/// Flaws of the mesh are reported, never thrown, whatever its arrays contain. Linear time except for the boundary,
/// which takes O(n log n); about 20 bytes per triangle besides the mesh. Throws LimitError above 1.4 billion triangles.
[[nodiscard]] VerifyReport verify(const Mesh& mesh, const VerifyOptions& options);

/// Also checks the mesh against its input, which must be planar, as repair() leaves it; otherwise, that is a flaw:
/// - the boundary of the mesh is the boundary of the domain, found from an arrangement of the input segments without
///   any triangulation; so every point of the domain is covered once, and nothing else is;
/// - every input segment in the domain is one chain of subsegments with its marker, in order along it and on it up to
///   the rounding of repeated midpoints; there are no other subsegments;
/// - every input point in the domain is a vertex with its marker and attributes (if listed; see point_data_check.hpp);
/// area, Euler number and region attributes (if listed) agree. The domain of an input with polygons is what they cover,
/// found by walking from face to face and counting borders. With options.given, that is done a second time with the
/// polygons as they were given; areas and regions must agree. An input without segments describes the convex hull of
/// its points, with marker 1 all around.
[[nodiscard]] VerifyReport verify(const Mesh& mesh, const Pslg& input, const VerifyOptions& options);

/// A mesh in pieces, each of which is shown when it is needed.
struct Pieces {
  using Show = std::function<void(const Mesh&)>;

  std::size_t count = 0;
  /// Calls show with piece k, more than once if it is asked for again; threads may ask at the same time.
  std::function<void(std::size_t k, const Show& show)> with_piece;
};

/// The same for a mesh in pieces, and checks that the pieces fit: points with the same number have the same
/// coordinates, marker and attributes to the last bit in every piece, and no number from 0 on is missing. If the whole
/// mesh also passes the checks above (where points in the same place with different numbers, and interior edges with
/// one triangle, are flaws), both sides of every interface have the same points and edges. `input` may be null. Throws
/// Error if a piece has no numbers.
///
/// What is inside a piece is checked in that piece alone. What is left are the triangles at points on its rim and on
/// subsegments: those of all pieces are joined and checked as one small mesh. So memory holds as many pieces as there
/// are threads, and all rims. A flaw may be found by another of its signs than in the joined mesh: points inside
/// different pieces in the same place are not listed, but the pieces overlap there, which is.
[[nodiscard]] VerifyReport verify_pieces(const Pieces& pieces, const Pslg* input, const VerifyOptions& options);
[[nodiscard]] VerifyReport verify_pieces(std::span<const Mesh> pieces, const Pslg* input, const VerifyOptions& options);

}  // namespace driftmesh
