#pragma once

namespace CLI {
class App;
}

namespace driftmesh::app {

// Each adds one subcommand, with its options and help, to the program. A subcommand's callback throws driftmesh::Error
// for what the user can mend; main prints its message and exits with 1, or 3 for a LimitError.

void add_mesh(CLI::App& program);
void add_check(CLI::App& program);
void add_convert(CLI::App& program);
void add_decompose(CLI::App& program);
void add_generate(CLI::App& program);
void add_plot(CLI::App& program);
void add_run(CLI::App& program);
void add_config(CLI::App& program);

}  // namespace driftmesh::app
