#pragma once

#include "driftmesh/size_field.hpp"

namespace driftmesh {

/// The same length everywhere.
class UniformField final : public SizeField {
 public:
  /// > 0 or +infinity.
  explicit UniformField(double length) : length_(length) {}
  [[nodiscard]] double edge_length(const Point&) const override { return length_; }
  [[nodiscard]] double least() const override { return length_; }

 private:
  double length_;
};

}  // namespace driftmesh
