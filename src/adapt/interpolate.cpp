#include "adapt/interpolate.hpp"

#include <utility>

namespace driftmesh::adapt {

void Interpolation::begin(const Lineage::Change& change) {
  lineage().visit_points(change, [&](std::int32_t point, const Lineage::Source& from) {
    for (std::size_t k = 0; k < components(); ++k) {
      const auto at = [&](int i) { return old()[to_index(from.point[i]) * components() + k]; };
      double& value = values_[to_index(point) * components() + k];
      value = from.stays ? at(0) : interpolated(from.weight, {at(0), at(1), at(2)});
    }
  });
}

std::vector<double> Interpolation::values() {
  lineage().settle_shared(values_, components());
  return std::move(values_);
}

}  // namespace driftmesh::adapt
