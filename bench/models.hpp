#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "driftmesh/pslg.hpp"

namespace driftmesh::bench {

struct Model {
  std::string name;
  Pslg pslg;
  double area = 0;  ///< area of the whole domain
};

/// pipe, cylinder_flow and chesapeake from the .poly files in `folder`, or similar generated ones if it has none; and a
/// rectangle with a 32-gon as a hole, whose few long edges make refinement start from a coarse triangulation.
[[nodiscard]] std::vector<Model> load_models(const std::filesystem::path& folder);

}  // namespace driftmesh::bench
