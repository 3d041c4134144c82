#include <CLI/CLI.hpp>
#include <exception>
#include <iostream>
#include <memory>
#include <new>

#include "app/commands.hpp"
#include "app/help_text.hpp"
#include "base/error.hpp"

namespace {

constexpr int kError = 1;
constexpr int kUsage = 2;
constexpr int kLimit = 3;

void add_commands(CLI::App& program) {
  using namespace driftmesh::app;
  add_mesh(program);
  add_check(program);
  add_convert(program);
  add_decompose(program);
  add_generate(program);
  add_plot(program);
}

int parse_and_run(CLI::App& program, int argc, char** argv) {
  try {
    program.parse(argc, argv);
    return 0;
  } catch (const CLI::RuntimeError& finished) {
    return finished.get_exit_code();
  } catch (const CLI::Success& help) {
    return program.exit(help);
  } catch (const CLI::ParseError& error) {
    std::cerr << "driftmesh: " << error.what() << "; see --help\n";
    return kUsage;
  }
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App program{"driftmesh: quality Delaunay meshes of planar domains", "driftmesh"};
  program.formatter(std::make_shared<driftmesh::app::HelpFormatter>());
  program.set_version_flag("--version", "driftmesh " DRIFTMESH_VERSION);
  program.require_subcommand(1);
  add_commands(program);
  program.footer("driftmesh COMMAND --help says what each can do.");  // last: commands inherit what is set before
  try {
    return parse_and_run(program, argc, argv);
  } catch (const std::bad_alloc&) {
    std::cerr << "driftmesh: out of memory; ask for larger triangles, or see --max-memory of driftmesh mesh\n";
    return kLimit;
  } catch (const driftmesh::LimitError& error) {
    std::cerr << "driftmesh: " << error.what() << '\n';
    return kLimit;
  } catch (const std::exception& error) {
    std::cerr << "driftmesh: " << error.what() << '\n';
  }
  return kError;
}
