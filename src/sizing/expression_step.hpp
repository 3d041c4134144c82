#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "sizing/interval.hpp"

namespace driftmesh {

enum class ExpressionOp : std::uint8_t {
  kX,  // no operands
  kY,
  kConstant,
  kVariable,  // its number is the step's constant
  kNegative,  // one
  kSquare,
  kSin,
  kCos,
  kTan,
  kAsin,
  kAcos,
  kAtan,
  kSinh,
  kCosh,
  kTanh,
  kLog2,
  kLog10,
  kLog,
  kExp,
  kSqrt,
  kSign,
  kRint,
  kAbs,
  kAdd,  // two
  kSubtract,
  kMultiply,
  kDivide,
  kPower,
  kLess,
  kAtMost,
  kGreater,
  kAtLeast,
  kEqual,
  kDifferent,
  kAnd,
  kOr,
  kMin,
  kMax,
  kAtan2,
  kHypot,
  kChoose,  // three
};

/// A step of a machine with a stack: takes operands from its top and puts their result there.
struct ExpressionStep {
  ExpressionOp op;
  Interval constant{};
};

/// The most operands that are on the stack at a time.
inline constexpr std::size_t kDeepestExpression = 64;

[[nodiscard]] std::size_t operands_of(ExpressionOp op);

/// The result of an operation on its operands, as muParser defines it: whatever is not 0 is true. NaN where there is
/// none.
[[nodiscard]] double apply(ExpressionOp op, const double* operands);
/// All results that it can have on operands in these intervals.
[[nodiscard]] Interval apply(ExpressionOp op, const Interval* operands);

}  // namespace driftmesh
