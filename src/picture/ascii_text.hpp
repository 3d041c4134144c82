#pragma once

#include <string>

namespace driftmesh {

/// A text of the pictures in ASCII, which is all that cairo's own letters have: 20°, 2·10⁻³ become 20 deg, 2*10^-3, and
/// any other letter a question mark.
[[nodiscard]] std::string ascii_text(const std::string& text);

}  // namespace driftmesh
