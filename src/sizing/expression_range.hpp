#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "geometry/box.hpp"
#include "sizing/interval.hpp"
#include "sizing/plane_function.hpp"

namespace driftmesh {

/// The values that an expression in x and y can take over a box, by interval arithmetic (Moore, "Interval Analysis",
/// 1966). They are never underestimated. They are exact but for rounding if x and y appear once each, and approach the
/// exact ones as the box shrinks otherwise.
class ExpressionRange {
 public:
  /// For an expression that muParser accepts; nothing if it uses what is not known here.
  /// `variables`: those that it may contain beside x and y.
  [[nodiscard]] static std::optional<ExpressionRange> of(const std::string& expression, PlaneVariables variables = {});

  /// Infinite ends are allowed.
  [[nodiscard]] Interval over(const Box& box) const;
  /// The value at a point, NaN where the expression has none.
  [[nodiscard]] double at(const Point& p) const;

 private:
  friend class ExpressionCompiler;
  enum class Op : std::uint8_t;
  /// A step of a machine with a stack: takes operands from its top and puts their result there.
  struct Step {
    Op op;
    Interval constant{};
  };

  static constexpr std::size_t kDeepest = 64;  // operands on the stack
  static std::size_t operands_of(Op op);
  static Interval apply(Op op, const Interval* operands);
  static Interval apply_to_numbers(Op op, const Interval* operands);
  [[nodiscard]] const PlaneFunction& function_of(const Step& step) const;
  static double apply(Op op, const double* operands);

  std::vector<Step> steps_;
  PlaneVariables variables_;
};

}  // namespace driftmesh
