#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <exception>
#include <iostream>
#include <memory>
#include <new>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "app/commands.hpp"
#include "app/help_text.hpp"
#include "app/limits.hpp"
#include "base/error.hpp"
#include "base/temporary_files.hpp"
#include "driftmesh/version.hpp"
#include "protocol/mpi/mpi_transport.hpp"

namespace {

constexpr int kError = 1;
constexpr int kUsage = 2;

void add_commands(CLI::App& program) {
  using namespace driftmesh::app;
  add_mesh(program);
  add_check(program);
  add_convert(program);
  add_decompose(program);
  add_generate(program);
  add_plot(program);
  add_run(program);
  add_config(program);
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

/// A process of mpirun other than rank 0: what it says is not shown, for rank 0 says the same.
class Follower {
 public:
  Follower() : errors_(std::cerr.rdbuf(said_.rdbuf())) { std::cout.rdbuf(nullptr); }
  ~Follower() { std::cerr.rdbuf(errors_); }
  Follower(const Follower&) = delete;
  Follower& operator=(const Follower&) = delete;

  /// Its exit code. An error before the ranks have met is usually everybody's: then rank 0 has said so, and mpirun ends
  /// this process while it waits. Otherwise it is this one's alone, a file that is missing on this host perhaps.
  [[nodiscard]] int end(int code) const {
    if (code == 0) return 0;
    std::this_thread::sleep_for(std::chrono::seconds(5));
    std::fputs(said_.str().c_str(), stderr);
    return code;
  }

  /// Whether it has anything to do: only `mesh` and `run` work on many ranks.
  [[nodiscard]] static bool is_needed(int argc, char** argv) {
    return argc >= 2 && (std::string(argv[1]) == "mesh" || std::string(argv[1]) == "run");
  }

 private:
  std::ostringstream said_;
  std::streambuf* errors_;
};

int run_program(int argc, char** argv) {
  CLI::App program{"driftmesh: quality Delaunay meshes of planar domains", "driftmesh"};
  program.formatter(std::make_shared<driftmesh::app::HelpFormatter>());
  program.set_version_flag("--version", "driftmesh " DRIFTMESH_VERSION);
  program.require_subcommand(1);
  add_commands(program);
  program.footer("driftmesh COMMAND --help says what each can do.");  // last: commands inherit what is set before
  try {
    return parse_and_run(program, argc, argv);
  } catch (const std::bad_alloc&) {
    std::cerr << "driftmesh: " << driftmesh::app::kOutOfMemory << '\n';
    return driftmesh::app::kStoppedByLimit;
  } catch (const driftmesh::LimitError& error) {
    std::cerr << "driftmesh: " << error.what() << '\n';
    return driftmesh::app::kStoppedByLimit;
  } catch (const std::exception& error) {
    std::cerr << "driftmesh: " << error.what() << '\n';
  }
  return kError;
}

}  // namespace

int main(int argc, char** argv) {
  driftmesh::remove_temporaries_on_signals();
  if (driftmesh::protocol::MpiSession::launched_as().value_or(0) == 0) return run_program(argc, argv);
  const Follower follower;
  return Follower::is_needed(argc, argv) ? follower.end(run_program(argc, argv)) : 0;
}
