#pragma once

#include <muParser.h>

#include <string>

namespace driftmesh {

/// muParser with what size expressions know besides: the constants pi and e, and hypot(a, b). Variables are up to the
/// caller.
[[nodiscard]] mu::Parser expression_parser();

/// Whether a name has a meaning in every size expression: a coordinate, a constant or a function.
[[nodiscard]] bool is_known_to_expressions(const std::string& name);

}  // namespace driftmesh
