#include <memory>
#include <string>

#include "app/commands.hpp"
#include "app/mesh_run.hpp"
#include "app/request_line.hpp"
#include "app/run_files.hpp"
#include "base/standard_streams.hpp"
#include "cli/values.hpp"
#include "config/experiment.hpp"
#include "job/check.hpp"
#include "protocol/mpi/mpi_transport.hpp"

namespace driftmesh::app {
namespace {

struct MeshCommand {
  GivenKeys given;
  std::string config;
  bool allow_code = false;
};

/// Runs the request of the command line and its settings file.
int run(const MeshCommand& command) {
  const bool launched = protocol::MpiSession::launched_as().has_value();
  if (launched && is_standard_stream(command.config))
    throw cli::UsageError("--config is standard input, which only one of the processes can read; name a file");
  config::Settings settings;
  if (!command.config.empty()) settings = config::read_settings(command.config);
  int code = 0;
  in_words_of_options(command.given, settings.places, [&] {
    command.given.apply(settings.request);
    for (const GivenKeys::Item& item : command.given.items) settings.places.erase(item.key->name);
    if (!command.allow_code) config::refuse_code_of_file(settings.request, settings.places);
    const job::Request& request = settings.request;
    const job::Request::Input& input = request.input;
    if (input.file.empty() && input.generator.empty() && input.parameters.empty() && input.contour.empty())
      throw cli::UsageError("INPUT is missing");
    const job::PlaceKind place = job::place_of(request, job::kMesh, launched);
    code = run_mesh(request, place, command_line_of("driftmesh mesh", request, job::kMesh), command.config);
  });
  return code;
}

}  // namespace

cli::Command mesh_command() {
  const auto command = std::make_shared<MeshCommand>();
  std::vector<cli::Option> options = key_options(job::kMesh, command->given);
  options.push_back({.name = "config",
                     .value = "FILE.yaml",
                     .help = "Read options from a YAML file, by their long names (input: bay.poly, area: 5000, output: "
                             "[a.vtu]) or as in experiments; the command line takes precedence",
                     .completes = cli::Option::Completes::kFile,
                     .take = cli::into(command->config)});
  options.push_back(allow_code_option(command->allow_code));
  return {.name = "mesh",
          .summary = "Generate a quality mesh of a domain",
          .options = std::move(options),
          .notes =
              "Processes started by mpirun generate the mesh together, in subdomains. To check a mesh: driftmesh "
              "check bay.vtu bay.poly --angle 20 --area 5000",
          .examples = {"driftmesh mesh bay.poly --area 5000 -o bay.vtu --plot bay.png",
                       "driftmesh mesh bay.poly --angle 30 -o bay.msh -o bay.ele",
                       "driftmesh mesh bay.poly --size \"20 + 0.1*abs(x)\" --json run.json",
                       "driftmesh mesh bay.poly --size \"20 + 0.1*distance(1)\" --size-max 500 -o bay.vtu",
                       "mpirun -n 4 driftmesh mesh bay.poly --area 50 -o bay.pvtu"},
          .exit_codes = "0 done, 1 error, 2 wrong usage, 3 stopped by a limit",
          .run = [command](cli::Call&) { return run(*command); }};
}

}  // namespace driftmesh::app
