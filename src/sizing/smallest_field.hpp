#pragma once

#include <algorithm>
#include <array>
#include <functional>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "driftmesh/size_field.hpp"

namespace driftmesh {

/// The smallest of several fields, but never less than `shortest`. +infinity without fields.
class SmallestField final : public SizeField {
 public:
  explicit SmallestField(std::vector<std::unique_ptr<SizeField>> fields, double shortest = 0)
      : fields_(std::move(fields)), shortest_(shortest) {}
  [[nodiscard]] double edge_length(const Point& p) const override {
    double length = std::numeric_limits<double>::infinity();
    for (const auto& field : fields_) length = std::min(length, field->edge_length(p));
    return std::max(length, shortest_);
  }
  [[nodiscard]] double least() const override {
    double length = std::numeric_limits<double>::infinity();
    for (const auto& field : fields_) length = std::min(length, field->least());
    return std::max(length, shortest_);
  }
  [[nodiscard]] double least_between(const std::array<Point, 3>& triangle, double at_corners) const override {
    double length = std::numeric_limits<double>::infinity();
    for (const auto& field : fields_)
      length = std::min(length, std::max(field->least_between(triangle, at_corners), field->least()));
    return std::max(length, shortest_);
  }
  [[nodiscard]] bool falls_below(const std::array<Point, 3>& triangle, double length) const override {
    return shortest_ < length && std::any_of(fields_.begin(), fields_.end(),
                                             [&](const auto& field) { return field->falls_below(triangle, length); });
  }
  void visit_marks(const std::function<void(const Point&)>& visit) const override {
    for (const auto& field : fields_) field->visit_marks(visit);
  }

 private:
  std::vector<std::unique_ptr<SizeField>> fields_;
  double shortest_;
};

}  // namespace driftmesh
