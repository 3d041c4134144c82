#pragma once

#include <string>

#include "cli/command.hpp"

namespace driftmesh::cli {

/// The manual page of a program, section 1, in the macros of man(7): all its commands with all their options. `version`
/// stands at the foot: "driftmesh 1.2.3".
[[nodiscard]] std::string manual_page(const Command& program, const std::string& version);

}  // namespace driftmesh::cli
