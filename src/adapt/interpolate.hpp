#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "adapt/field_transfer.hpp"

namespace driftmesh::adapt {

/// Between the values at the corners of a triangle, and never beyond them. Weights are >= 0 and sum to 1.
[[nodiscard]] inline double interpolated(const std::array<double, 3>& weight, const std::array<double, 3>& at) {
  const auto [least, most] = std::minmax({at[0], at[1], at[2]});
  return std::clamp(weight[0] * at[0] + weight[1] * at[1] + weight[2] * at[2], least, most);
}

/// Values at points, linear between them. A point that stays keeps its bits.
class Interpolation final : public FieldTransfer {
 public:
  Interpolation(const Lineage& lineage, const Field& field)
      : FieldTransfer(lineage, field), values_(lineage.new_points() * components()) {}

  void begin(const Lineage::Change& change) override;
  [[nodiscard]] std::vector<double> values() override;

 private:
  std::vector<double> values_;
};

}  // namespace driftmesh::adapt
