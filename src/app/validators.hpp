#pragma once

#include <CLI/CLI.hpp>
#include <cmath>
#include <string>

namespace driftmesh::app {

/// Accepts finite numbers above zero.
inline CLI::Validator positive() {
  return {[](const std::string& text) -> std::string {
            double value = 0;
            if (CLI::detail::lexical_cast(text, value) && value > 0 && std::isfinite(value)) return {};
            return "'" + text + "' is not a positive number";
          },
          ""};
}

}  // namespace driftmesh::app
