#include <chrono>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <iostream>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "app/commands.hpp"
#include "base/failure.hpp"
#include "base/standard_streams.hpp"
#include "base/temporary_files.hpp"
#include "cli/command_line.hpp"
#include "driftmesh/version.hpp"
#include "job/files.hpp"
#include "job/limits.hpp"
#include "protocol/mpi/mpi_transport.hpp"
#include "report/report_page.hpp"

namespace {

using namespace driftmesh;
using namespace driftmesh::app;

constexpr int kError = 1;

std::string version_text() {
#ifdef __clang__
  const std::string compiler = "Clang " __clang_version__;
#else
  const std::string compiler = "GCC " __VERSION__;
#endif
  return "driftmesh " DRIFTMESH_VERSION "\ncompiler: " + compiler + "\nlibraries: " + protocol::MpiSession::library() +
         ", " DRIFTMESH_LIBRARIES "\n";
}

cli::Command commands_of_program() {
  cli::Command program{
      .name = "driftmesh",
      .summary = "Quality Delaunay meshes of planar domains, on one core or on many ranks",
      .options = {{.kind = cli::Option::Kind::kFlag,
                   .name = "version",
                   .help = "Print the versions of the program, its compiler and its libraries",
                   .prints = version_text}},
      .commands = {mesh_command(), adapt_command(), check_command(), convert_command(), decompose_command(),
                   generate_command(), plot_command(), run_command(), replay_command(), calibrate_command(),
                   triangle_command(), clean_command()},
      .notes =
          "For the options of a command, see: driftmesh COMMAND --help\n\n"
          "In place of any file name, - stands for standard input or output; an extension after it selects the "
          "format: -.msh, -.svg. Without one, meshes are .vtu, pictures .png, and domains .poly. While a file goes "
          "to standard output, messages go to standard error."};
  if (has_report_page()) program.commands.push_back(report_command());
  return program;
}

/// Flushes all buffers.
int flushed(int code) {
  flush_standard_output();
  return code;
}

/// A process of mpirun other than rank 0: its output is suppressed, since rank 0 prints the same.
class Follower {
 public:
  Follower() : errors_(std::cerr.rdbuf(said_.rdbuf())) { mute_standard_output(); }
  ~Follower() { std::cerr.rdbuf(errors_); }
  Follower(const Follower&) = delete;
  Follower& operator=(const Follower&) = delete;

  /// Its exit code. An error before the ranks have met usually occurs on all of them: then rank 0 has reported it, and
  /// mpirun ends this process while it waits. Otherwise only this process has it, perhaps because a file is missing on
  /// this host.
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

/// Experiments name keys in full, all other commands by their options.
Words words_of_command(int argc, char** argv) {
  return job::words_of(argc >= 2 && std::string(argv[1]) == "run" ? job::kExperiment : job::kMesh);
}

int run_program(int argc, char** argv) {
  cli::Command program = commands_of_program();
  program.commands.push_back(config_command(program));
  program.commands.push_back(help_command(program));
  try {
    return flushed(cli::run(program, argc, argv));
  } catch (const std::exception&) {
    const Failure failure = failure_of(std::current_exception());
    std::cerr << "driftmesh: " << text_of(failure).in(words_of_command(argc, argv)) << '\n';
    return failure.kind == Failure::Kind::kLimit ? job::kStoppedByLimit : kError;
  }
}

/// The words of the command line. Through a link named triangle, the program is its command of that name.
std::vector<char*> words_of(int argc, char** argv) {
  static char triangle[] = "triangle";
  std::vector<char*> words(argv, argv + argc);
  if (argc > 0 && std::filesystem::path(argv[0]).filename() == triangle) words.insert(words.begin() + 1, triangle);
  return words;
}

int run(int argc, char** argv) {
  driftmesh::hold_closed_streams();
  driftmesh::remove_temporaries_on_signals();
  if (driftmesh::protocol::MpiSession::launched_as().value_or(driftmesh::Rank{0}) == driftmesh::Rank{0})
    return run_program(argc, argv);
  const Follower follower;
  return Follower::is_needed(argc, argv) ? follower.end(run_program(argc, argv)) : 0;
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<char*> words = words_of(argc, argv);
  return run(static_cast<int>(words.size()), words.data());
}
