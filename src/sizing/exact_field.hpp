#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <vector>

#include "driftmesh/size_field.hpp"
#include "geometry/box.hpp"
#include "sizing/background_function.hpp"
#include "sizing/plane_function.hpp"

namespace driftmesh {

/// The lengths of a function, each as the function gives it, for those who judge a mesh. The domain is divided into
/// cells, in each of which the function is narrowed when it is first asked for. Several threads may ask at once.
class ExactField final : public SizeField {
 public:
  /// `field`: throws where the function is not positive; null if it is positive everywhere. `background`: the part of
  /// the function that has marks, or null.
  ExactField(std::shared_ptr<const SizeField> field, std::shared_ptr<const PlaneFunction> function,
             std::shared_ptr<const BackgroundFunction> background, const Box& domain);
  [[nodiscard]] double edge_length(const Point& p) const override;
  void visit_marks(const std::function<void(const Point&)>& visit) const override;

 private:
  static constexpr int kCells = 256;  // along each side of the domain
  struct Cell {
    std::once_flag is_made;
    std::shared_ptr<const PlaneFunction> function;
  };
  [[nodiscard]] const PlaneFunction& function_at(const Point& p) const;

  std::shared_ptr<const SizeField> field_;
  std::shared_ptr<const PlaneFunction> function_;
  std::shared_ptr<const BackgroundFunction> background_;
  Box domain_;
  mutable std::vector<Cell> cells_;
};

}  // namespace driftmesh
