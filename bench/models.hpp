#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "pslg/pslg.hpp"

namespace driftmesh::bench {

struct Model {
  std::string name;
  Pslg pslg;
  double area = 0;  ///< of the domain
};

/// pipe, cylinder_flow and chesapeake as far as `folder` holds their .poly files, and the rectangle with a hole.
[[nodiscard]] std::vector<Model> load_models(const std::filesystem::path& folder);

/// A 2 x 1 rectangle with a regular 32-gon of radius 0.2 cut out of its middle: few, long segments, so that refinement
/// starts from a very coarse triangulation.
[[nodiscard]] Pslg rectangle_with_hole();

/// The unit square with `points` random points in it and `segments` segments between them that do not cross: a hundred
/// chains that run left to right, each in a strip of its own. Both counts are rounded down to hundreds.
[[nodiscard]] Pslg points_with_chains(std::size_t points, std::size_t segments, std::uint64_t seed);

}  // namespace driftmesh::bench
