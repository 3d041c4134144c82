#pragma once

#include <string>
#include <vector>

namespace driftmesh {

/// The one of `known` that `name` was probably meant to be: one that contains it as a word, such as max_area for area,
/// or has one letter more, and among these, or all if there is none, the one with the fewest letters to insert, remove,
/// replace or swap with their neighbor, ignoring case. The first of several; "" if `known` is empty.
[[nodiscard]] std::string nearest_name(const std::string& name, const std::vector<std::string>& known);

/// The same if it is near: one that begins with `name`, contains it as a word, or differs from it in at most a third of
/// the letters. Otherwise "".
[[nodiscard]] std::string probable_name(const std::string& name, const std::vector<std::string>& known);

}  // namespace driftmesh
