#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "driftmesh/error.hpp"
#include "driftmesh/pslg.hpp"
#include "sizing/expression_table.hpp"
#include "sizing/medial_axis.hpp"
#include "sizing/named_raster.hpp"
#include "sizing/plane_function.hpp"

namespace driftmesh {

/// A step of a machine with a stack: an operation takes operands from its top and puts their result there, a leaf puts
/// its value there.
struct ExpressionStep {
  enum class Leaf : std::uint8_t { kX, kY, kConstant, kFunction };
  const Operation* operation = nullptr;  ///< null: a leaf
  Leaf leaf = Leaf::kConstant;
  double constant = 0;
  std::size_t function = 0;  ///< its index
};

struct ParsedExpression {
  std::vector<ExpressionStep> steps;
  std::vector<std::shared_ptr<const PlaneFunction>> functions;
};

/// The most values that are on the stack at a time, and the most operators and parentheses within one another.
inline constexpr std::size_t kDeepestExpression = 1000;
inline constexpr std::size_t kLongestExpression = 100'000;  ///< characters

/// The steps of an expression; docs/size-expressions.md has the grammar. `input`: with the segments that distance
/// measures to, needed no longer than this call; null: none. `outline`: that of the domain, of which width measures the
/// width. Throws InputError naming the column where the expression is wrong, and the markers that exist where distance
/// asks for another.
[[nodiscard]] ParsedExpression parse_expression(const std::string& text, const Pslg* input, const NamedRasters& rasters,
                                                const FindOutline& outline);

/// Where an error in an expression is: its beginning, if it is long.
[[nodiscard]] SourcePlace place_of_expression(const std::string& text);

/// Whether a name has a meaning in every expression: a coordinate, a constant or a function.
[[nodiscard]] bool is_known_to_expressions(std::string_view name);

}  // namespace driftmesh
