#pragma once

#include <memory>
#include <string>

#include "driftmesh/size_field.hpp"

namespace driftmesh {

/// The target edge length as an expression in x and y, for example "0.01 + 0.2*sqrt(x^2 + y^2)". The operators,
/// functions and conditionals are those of muParser, with pi, e and hypot(a, b) in addition.
class ExpressionField final : public SizeField {
 public:
  /// Values below `shortest` count as `shortest`. Throws InputError naming the column and the token where the
  /// expression is wrong.
  explicit ExpressionField(const std::string& expression, double shortest = 0);
  ~ExpressionField() override;

  /// Throws InputError naming `p` if the value there is NaN or not positive.
  [[nodiscard]] double edge_length(const Point& p) const override;

 private:
  struct Parser;
  std::unique_ptr<Parser> parser_;
  double shortest_;
};

}  // namespace driftmesh
