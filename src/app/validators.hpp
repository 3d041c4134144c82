#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace driftmesh::app {

/// Accepts finite numbers above zero.
[[nodiscard]] CLI::Validator positive();

/// Turns a number from 1 to `largest` with an optional unit k, M, G or T, of `thousand` to the power 1 to 4, into a
/// plain whole number: "50M", "1.5G", "2e6". A B or iB behind the unit changes nothing.
[[nodiscard]] CLI::Validator size_value(double thousand, double largest);

}  // namespace driftmesh::app
