#pragma once

#include "sizing/make_size_field.hpp"

namespace CLI {
class App;
}

namespace driftmesh::app {

/// Adds the options that ask for sizes of triangles (--size and so on) to a subcommand's help group. `sizing` must
/// outlive the subcommand.
void add_sizing_options(CLI::App& command, SizingOptions& sizing, const char* group);

/// Throws CLI::ParseError for sizing options that do not go together.
void check_sizing_options(const SizingOptions& sizing);

}  // namespace driftmesh::app
