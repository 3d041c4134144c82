#pragma once

#include <string>
#include <vector>

#include "decompose/decomposition.hpp"

namespace driftmesh {

/// Measurements of a decomposition, and its faults.
struct DecompositionReport {
  /// Descriptions of broken invariants, at most kMaxProblems.
  std::vector<std::string> problems;
  double smallest_angle = 180;                ///< degrees, between a separator and any adjacent root, inside the domain
  GlobalPointId smallest_at = kNoPoint;       ///< the point with that angle
  std::vector<std::int32_t> angle_histogram;  ///< counts of those angles by steps of 10: [0, 10), ..., [170, 180]
  double area = 0;                            ///< sum over all subdomains
  double border_length = 0;                   ///< roots with the domain on one side
  double separator_length = 0;
  double largest_load = 0;  ///< predicted work of a subdomain, relative to the mean
  double smallest_load = 0;

  static constexpr std::size_t kMaxProblems = 20;
  [[nodiscard]] bool valid() const { return problems.empty(); }
};

/// Checks the invariants that Decomposition states, from the points and roots alone: indices in range, each root's
/// direction, coordinates in range; the roots around every point agree on the subdomains and regions between them; each
/// subdomain has one outer border (it is connected) and the area that it claims; the lists match the roots, and inner
/// points lie in their subdomains; no two roots cross. Uses exact orientation; areas must agree to about 1e-9 of the
/// domain.
[[nodiscard]] DecompositionReport check_decomposition(const Decomposition& decomposition);

}  // namespace driftmesh
