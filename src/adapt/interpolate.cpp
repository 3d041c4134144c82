#include "adapt/interpolate.hpp"

namespace driftmesh::adapt {

std::vector<double> interpolated_at_points(const Lineage& lineage, const std::vector<double>& old,
                                           std::size_t components) {
  std::vector<double> values(lineage.new_points() * components);
  lineage.visit_points([&](std::int32_t point, const Lineage::Source& from) {
    for (std::size_t k = 0; k < components; ++k) {
      const auto at = [&](int i) { return old[to_index(from.point[i]) * components + k]; };
      double& value = values[to_index(point) * components + k];
      value = from.stays ? at(0) : interpolated(from.weight, {at(0), at(1), at(2)});
    }
  });
  lineage.settle_shared(values, components);
  return values;
}

}  // namespace driftmesh::adapt
