#pragma once

#include <cstdint>

#include "decompose/decomposition.hpp"
#include "driftmesh/defaults.hpp"
#include "mesh/bounds.hpp"
#include "mesh/triangulation.hpp"

namespace driftmesh {

struct DecomposeOptions {
  std::int32_t subdomains = 1;
  /// Degrees, 0 to kMaxSeparatorAngle: the smallest angle between separators and whatever they meet, where the domain
  /// allows it.
  double min_angle = defaults::kSeparatorAngle;
  /// The bounds on the mesh: subdomains are balanced by the number of triangles they require, or by area if there is no
  /// bound on size.
  QualityBounds bounds;
  double forecast = 0;  ///< forecast_triangles of the mesh and these bounds, where it is known; 0: it is made if needed
  /// 0: equal work. Above, up to kMaxSkew: deliberately uneven, for experiments; each cut gives one side up to (1 +
  /// skew) times its fair share, at random.
  double skew = 0;
  std::uint64_t seed = 1;  ///< seed for that randomness
  /// Whether separators end only at points of the domain, and on each other.
  bool whole_segments = false;
};

inline constexpr std::int32_t kMaxSubdomains = 10'000'000;
inline constexpr int kMaxSeparatorAngle = 80;  // degrees
inline constexpr int kMaxSkew = 1;

/// Cuts a triangulated domain (see triangulate and prepare_corners; not refined yet) into subdomains of about equal
/// work, connected ones unless the domain has more disconnected parts than there are to be subdomains (then small parts
/// that lie near each other share one), with short straight separators that make large angles with everything they
/// meet. Deterministic: the same triangulation and options give the same decomposition.
///
/// After Linardakis and Chrisochoides, "Algorithm 870: A Static Geometric Medial Axis Domain Decomposition in 2D
/// Euclidean Space" (2008), recursive bisection by separators between points of the border; the search for the best
/// separator is our own (see docs/decomposition.md). Segments inside the domain become borders of subdomains where that
/// suits the balance; otherwise they stay inside one. Shell pieces of acute corners stay shell pieces.
///
/// Throws Error for options out of range, and if the domain cannot be cut into that many.
[[nodiscard]] Decomposition decompose(const Triangulation& mesh, const DecomposeOptions& options);

}  // namespace driftmesh
