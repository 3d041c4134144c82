#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "sizing/variation.hpp"

namespace driftmesh {

// The operators, functions and constants of size expressions. The parser, the suggestions in its errors and the table
// in docs/size-expressions.md are made from these.

/// What is made of some operands. Whatever is not 0 is true.
struct Operation {
  enum class Result : std::uint8_t { kNumber, kTruth, kOperand };
  int operands;
  double (*value)(const double* operands);      ///< NaN where there is none
  Interval (*range)(const Interval* operands);  ///< over operands that are numbers; kAll where it may be undefined
  /// By the chain rule, from operands and their slopes in the same directions; null: unknown unless the value is
  /// constant.
  Interval (*slope)(const Interval* operands, const Interval* slopes) = nullptr;
  Result result = Result::kNumber;

  /// Holds all values and slopes that it can have where the operands vary like this.
  [[nodiscard]] Variation over(const Variation* operands) const;
};

/// A binary operator. Those that bind more tightly have a greater precedence; equals group from the left, `^` from the
/// right.
struct Operator {
  std::string_view token;
  int precedence;
  Operation operation;
};

struct Function {
  /// Whether it takes as many arguments as its operation, or any number, from the left, and divides by it.
  enum class Arguments : std::uint8_t { kFixed, kAny, kAnyForMean };
  std::string_view name, arguments, meaning;
  Operation operation;
  Arguments takes = Arguments::kFixed;
  std::span<const double> defaults = {};  ///< what the last arguments are if they are not given
};

struct NamedConstant {
  std::string_view name;
  double value;
};

[[nodiscard]] std::span<const Operator> expression_operators();
[[nodiscard]] std::span<const Function> expression_functions();
[[nodiscard]] std::span<const NamedConstant> expression_constants();

extern const Operation kNegative, kSquare;
extern const Operation kChoose;  ///< condition ? then : otherwise

/// The most operands that an operation takes.
inline constexpr int kMostOperands = 4;

/// The functions as a table in Markdown.
[[nodiscard]] std::string expression_functions_table();

}  // namespace driftmesh
