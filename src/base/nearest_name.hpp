#pragma once

#include <string>
#include <vector>

namespace driftmesh {

/// The one of `known` that `name` was probably meant to be: the fewest letters to insert, remove, replace or exchange
/// with their neighbor, whatever their case. The first of several; "" when none is known.
[[nodiscard]] std::string nearest_name(const std::string& name, const std::vector<std::string>& known);

/// The same if it is near: one that `name` is the beginning of, or from which it differs in a third of the letters at
/// most. Otherwise "".
[[nodiscard]] std::string probable_name(const std::string& name, const std::vector<std::string>& known);

}  // namespace driftmesh
