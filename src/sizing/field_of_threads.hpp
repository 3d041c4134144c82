#pragma once

#include <array>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "base/thread_place.hpp"
#include "driftmesh/size_field.hpp"

namespace driftmesh {

/// One size field for threads that ask at once: each asks an object of its own, the one at its thread_place().
class FieldOfThreads final : public SizeField {
 public:
  /// Equal fields, one for each thread.
  explicit FieldOfThreads(std::vector<std::unique_ptr<const SizeField>> fields) : fields_(std::move(fields)) {}
  [[nodiscard]] double edge_length(const Point& p) const override { return own().edge_length(p); }
  [[nodiscard]] bool falls_below(const std::array<Point, 3>& triangle, double length) const override {
    return own().falls_below(triangle, length);
  }
  [[nodiscard]] double least() const override { return own().least(); }
  [[nodiscard]] double least_near(const std::array<Point, 3>& triangle) const override {
    return own().least_near(triangle);
  }
  [[nodiscard]] double least_between(const std::array<Point, 3>& triangle, double at_corners) const override {
    return own().least_between(triangle, at_corners);
  }
  void visit_marks(const std::function<void(const Point&)>& visit) const override { own().visit_marks(visit); }

 private:
  [[nodiscard]] const SizeField& own() const { return *fields_[thread_place()]; }

  std::vector<std::unique_ptr<const SizeField>> fields_;
};

}  // namespace driftmesh
