#pragma once

#include <limits>
#include <memory>
#include <string>

#include "driftmesh/pslg.hpp"
#include "driftmesh/size_field.hpp"
#include "sizing/medial_axis.hpp"
#include "sizing/named_raster.hpp"
#include "sizing/plane_function.hpp"

namespace driftmesh {

/// The target edge length as an expression in x and y, for example "0.01 + 0.2*sqrt(x^2 + y^2)": see
/// docs/size-expressions.md. Knows values at points alone; a SizeTree knows more.
class ExpressionField final : public SizeField {
 public:
  /// Values below `shortest` count as `shortest`, those above `longest` as `longest`. The others, and errors: see
  /// parse_expression.
  explicit ExpressionField(const std::string& expression, double shortest = 0,
                           double longest = std::numeric_limits<double>::infinity(), const Pslg* input = nullptr,
                           const NamedRasters& rasters = {}, const FindOutline& outline = {});

  /// Throws InputError naming `p` if the value there is NaN or not positive.
  [[nodiscard]] double edge_length(const Point& p) const override;

  [[nodiscard]] double least() const override;

  /// The same lengths with what is known of them over boxes: not positive, or NaN, where edge_length throws.
  [[nodiscard]] const std::shared_ptr<const PlaneFunction>& function() const { return function_; }

 private:
  std::string text_;
  std::shared_ptr<const PlaneFunction> function_;
};

}  // namespace driftmesh
