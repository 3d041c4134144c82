#include "adapt/interpolate.hpp"

#include <algorithm>

namespace driftmesh::adapt {

std::vector<double> interpolated_at_points(const Lineage& lineage, const std::vector<double>& old,
                                           std::size_t components) {
  std::vector<double> values(lineage.new_points() * components);
  lineage.visit_points([&](std::int32_t point, const Lineage::Source& from) {
    for (std::size_t k = 0; k < components; ++k) {
      const auto at = [&](int i) { return old[to_index(from.point[i]) * components + k]; };
      double& value = values[to_index(point) * components + k];
      value = at(0);
      if (from.stays) continue;
      const auto [least, most] = std::minmax({at(0), at(1), at(2)});
      value = std::clamp(from.weight[0] * at(0) + from.weight[1] * at(1) + from.weight[2] * at(2), least, most);
    }
  });
  lineage.settle_shared(values, components);
  return values;
}

}  // namespace driftmesh::adapt
