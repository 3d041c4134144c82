#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "sizing/expression_step.hpp"
#include "sizing/plane_function.hpp"

namespace driftmesh {

/// The steps of an expression in x, y and these variables, with the functions and precedences of muParser. Nothing if
/// it uses what is not known here, or needs a deeper stack.
[[nodiscard]] std::optional<std::vector<ExpressionStep>> compile_expression(std::string_view text,
                                                                            const PlaneVariables& variables);

}  // namespace driftmesh
