#include <CLI/CLI.hpp>
#include <exception>
#include <iostream>
#include <memory>
#include <new>
#include <string>
#include <vector>

#include "app/commands.hpp"
#include "app/help_text.hpp"
#include "base/error.hpp"
#include "base/temporary_files.hpp"

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

/// What is wrong with the command line, and where to look: in the help of the command that was meant.
std::string usage_message(const CLI::App& program, const CLI::ParseError& error) {
  std::string what = error.what();
  const std::vector<std::string> unknown = program.remaining(true);
  if (!unknown.empty()) what = "unexpected: " + CLI::detail::join(unknown, " ");
  const CLI::App* command = &program;
  std::string call = "driftmesh";
  for (; !command->get_subcommands().empty(); call += " " + command->get_name())
    command = command->get_subcommands().front();
  if (unknown.empty() && dynamic_cast<const CLI::RequiredError*>(&error) != nullptr &&
      command->get_require_subcommand_min() > 0)
    what = "a command is missing";
  return what + "; see " + call + " --help";
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
    std::cerr << "driftmesh: " << usage_message(program, error) << '\n';
    return kUsage;
  }
}

}  // namespace

int main(int argc, char** argv) {
  driftmesh::remove_temporaries_on_signals();
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
