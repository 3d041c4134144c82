#pragma once

#include <string>

namespace driftmesh {

/// A text, such as a file name, with the characters that are special in XML escaped.
[[nodiscard]] std::string escaped(const std::string& text);
/// The reverse.
[[nodiscard]] std::string unescaped(std::string text);

}  // namespace driftmesh
