#pragma once

#include <cstdint>
#include <vector>

#include "job/domain.hpp"
#include "job/request.hpp"
#include "job/watch.hpp"
#include "mesh/bounds.hpp"
#include "mesh/triangulation.hpp"

namespace driftmesh::job {

/// Whether a domain will be cut into subdomains.
enum class Cut {
  kNever,
  kIfLarge,  ///< for threads, which make large meshes faster in subdomains
  kAlways,
};

/// A domain ready for refinement or decomposition.
struct Triangulated {
  Triangulation mesh;  ///< constrained Delaunay, acute corners prepared
  bool cut = false;    ///< whether it is to be cut, and its corners are prepared for that
  std::int32_t acute_corners = 0;
  std::vector<Point> holes;  ///< a point in each hole, for formats that need one
  QualityBounds bounds;      ///< refers to the domain's size field
  double forecast = 0;       ///< triangles after refinement
};

/// Triangulates the domain, warns of what its author may not have meant, prepares its corners, and determines the
/// bounds that the request sets on its mesh on this number of ranks: if it names a number of triangles, the area bound
/// is the one that gives about as many. Throws what triangulate throws.
[[nodiscard]] Triangulated triangulate_domain(const Request& request, const Domain& domain, std::int32_t ranks, Cut cut,
                                              Watch& watch);

}  // namespace driftmesh::job
