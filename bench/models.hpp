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

/// pipe, cylinder_flow and chesapeake from the .poly files in `folder`, or generated ones of their kind where it has
/// none; and a rectangle with a 32-gon as a hole, whose few long edges let refinement start from a coarse
/// triangulation.
[[nodiscard]] std::vector<Model> load_models(const std::filesystem::path& folder);

/// The unit square with `points` random points in it and `segments` segments between them that do not cross: a hundred
/// chains that run left to right, each in a strip of its own. Both counts are rounded down to hundreds.
[[nodiscard]] Pslg points_with_chains(std::size_t points, std::size_t segments, std::uint64_t seed);

}  // namespace driftmesh::bench
