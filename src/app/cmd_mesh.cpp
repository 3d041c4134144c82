#include <memory>
#include <set>
#include <string>

#include "app/commands.hpp"
#include "app/mesh_run.hpp"
#include "app/request_line.hpp"
#include "app/run_files.hpp"
#include "base/standard_streams.hpp"
#include "cli/values.hpp"
#include "config/experiment.hpp"
#include "job/check.hpp"
#include "job/checkpoint_file.hpp"
#include "protocol/mpi/mpi_transport.hpp"

namespace driftmesh::app {
namespace {

struct MeshCommand {
  GivenKeys given;
  std::string config;
  bool allow_code = false;
  bool reproducible = false;  // --method rounds
};

/// What was asked for makes the mesh in rounds, unless another method is asked for.
void imply_rounds(job::Request& request, const std::set<std::string>& given, bool reproducible) {
  const job::Request::Run& run = request.run;
  const char* const why = reproducible                      ? "reproducible"
                          : !run.resume.empty()             ? "run.resume"
                          : !run.checkpoint.empty()         ? "run.checkpoint"
                          : !request.output.session.empty() ? "output.session"
                                                            : nullptr;
  if (why == nullptr) return;
  if (given.contains("run.method") && run.method != job::Method::kRounds)
    throw job::KeyError("run.method", KeyText::of("is not rounds, which {} implies", KeyText::key(why)),
                        "remove one of them");
  request.run.method = job::Method::kRounds;
}

std::set<std::string> given_keys(const GivenKeys& given, const config::SourcePlaces& places) {
  std::set<std::string> names = given.names();
  for (const auto& [name, place] : places) names.insert(name);
  return names;
}

/// The command that makes the same mesh from its beginning.
std::string repeating_command(job::Request request) {
  request.run.resume.clear();
  return command_line_of("driftmesh mesh", request, job::kMesh);
}

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
    job::Request& request = settings.request;
    const std::set<std::string> given = given_keys(command.given, settings.places);
    if (!request.run.resume.empty()) request = job::resumed_request(request, given);
    imply_rounds(request, given, command.reproducible);
    job::check_given(request, given);
    const job::Request::Input& input = request.input;
    if (input.file.empty() && input.generator.empty() && input.parameters.empty() && input.contour.empty())
      throw cli::UsageError("INPUT is missing");
    const job::PlaceKind place = job::place_of(request, job::kMesh, launched);
    code = run_mesh(request, place, repeating_command(request), command.config);
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
  options.push_back({.kind = cli::Option::Kind::kFlag,
                     .name = "reproducible",
                     .help = "Make a mesh that does not depend on the number of ranks: --method rounds",
                     .group = "Subdomains and ranks",
                     .take = cli::into(command->reproducible)});
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
                       "mpirun -n 4 driftmesh mesh bay.poly --area 50 -o bay.pvtu",
                       "driftmesh mesh bay.poly --area 5000 --save flow.h5",
                       "mpirun -n 4 driftmesh mesh bay.poly --area 50 --checkpoint bay.kept --every 10m -o bay.pvtu",
                       "mpirun -n 8 driftmesh mesh --resume bay.kept -o bay.pvtu"},
          .exit_codes = "0 done, 1 error, 2 wrong usage, 3 stopped by a limit",
          .run = [command](cli::Call&) { return run(*command); }};
}

}  // namespace driftmesh::app
