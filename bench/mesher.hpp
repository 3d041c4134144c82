#pragma once

#include <cstdint>

#include "driftmesh/pslg.hpp"

namespace driftmesh::bench {

/// The bounds on every triangle.
struct Bounds {
  double area = 0;     ///< largest area
  double degrees = 0;  ///< least angle
};

/// One run of a mesher, from input in memory to mesh in memory. Plain data: it comes from a child process.
struct MeshRun {
  std::int64_t vertices = 0;
  std::int64_t triangles = 0;   ///< inside the domain
  double smallest_angle = 0;    ///< degrees; measured by the benchmark, not by the mesher
  double largest_area = 0;      ///< likewise
  double seconds_cdt = 0;       ///< inserting points and segments, carving holes, and whatever else precedes refinement
  double seconds_refine = 0;    ///< refinement alone: the stage that is compared
  std::int64_t peak_bytes = 0;  ///< the process's peak at the end of refinement
};

/// A mesher to be measured.
struct Mesher {
  const char* name;
  /// The constrained Delaunay triangulation of the input, without refinement.
  MeshRun (*triangulate)(const Pslg& pslg);
  /// Triangulation and refinement. Regions of the input are ignored.
  MeshRun (*refine)(const Pslg& pslg, const Bounds& bounds);
};

}  // namespace driftmesh::bench
