#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "app/commands.hpp"
#include "app/progress_line.hpp"
#include "app/run_files.hpp"
#include "base/standard_streams.hpp"
#include "cli/values.hpp"
#include "config/words.hpp"
#include "protocol/mpi/mpi_transport.hpp"
#include "study/experiment_runs.hpp"
#include "study/real_cluster.hpp"

namespace driftmesh::app {
namespace {

struct RunCommand {
  std::string file;
  std::vector<std::string> settings;
  study::ExperimentRuns::Options results;
  bool allow_code = false;
  bool dry = false;
  bool quiet = false;
};

/// Shows the progress of a run, and messages of its ranks.
class RunView final : public job::Watch {
 public:
  explicit RunView(ProgressLine& line) : line_(line) {}
  void warned(const std::string& warning) override {
    if (said_.insert(warning).second) line_.write("warning: " + warning + "\n");
  }
  void refining(std::int64_t triangles, double forecast) override { line_.refining(triangles, forecast); }
  void stalled(const std::string& why) override { fmt::print(stderr, "driftmesh: {}\n", why); }

 private:
  ProgressLine& line_;
  std::set<std::string> said_;  // runs of one experiment mostly share their domain
};

std::string line_of(const RunCommand& command) {
  std::string line = "driftmesh run " + command.file;
  for (const std::string& setting : command.settings) line += fmt::format(" --set '{}'", setting);
  return line;
}

/// `cluster`: for real ranks; null if none of the runs needs them.
void make_all(const RunCommand& command, const config::Experiment& file, study::RealCluster* cluster) {
  study::ExperimentRuns runs(file, line_of(command), command.results, cluster);
  ProgressLine progress(!command.quiet);
  if (command.results.resume) progress.write(fmt::format("{} of {} runs are there\n", runs.made(), runs.size()));
  RunView view(progress);
  for (std::size_t i = runs.made(); i < runs.size(); ++i) {
    progress.begin(fmt::format("run {} of {}", i + 1, runs.size()));
    runs.make(i, view);
  }
  const auto page = runs.report();
  progress.end();
  if (command.quiet) return;
  const std::string advice = page ? fmt::format("; open {} in a browser", page->string()) : "";
  print(fmt::format("{}\nresults in {}/{}\n", runs.table().markdown(), runs.folder().string(), advice));
}

bool needs_real_ranks(const config::Experiment& file) {
  return std::any_of(file.points.begin(), file.points.end(), [](const config::SweepPoint& point) {
    return point.request.cluster.kind == job::ClusterKind::kReal;
  });
}

void run_experiment(const RunCommand& command) {
  std::optional<study::RealCluster> cluster;
  if (protocol::MpiSession::launched_as()) cluster.emplace();
  if (cluster && !cluster->leads()) return cluster->serve();
  const config::Experiment file = config::read_experiment(command.file, command.settings, command.allow_code);
  const auto runs = file.points.size() * static_cast<std::size_t>(file.base.repetitions);
  if (command.dry) {
    print(config::experiment_text(file) + fmt::format("# {} {}\n", runs, runs == 1 ? "run" : "runs"));
    return;
  }
  config::check_processes(file, cluster ? cluster->ranks() : 1);
  if (!cluster && needs_real_ranks(file)) cluster.emplace();
  make_all(command, file, cluster ? &*cluster : nullptr);
}

}  // namespace

cli::Command run_command() {
  const auto command = std::make_shared<RunCommand>();
  return {
      .name = "run",
      .summary = "Run an experiment",
      .options = {{.kind = cli::Option::Kind::kPositional,
                   .name = "experiment",
                   .value = "FILE.yaml",
                   .help = "The file that describes the experiment",
                   .required = true,
                   .completes = cli::Option::Completes::kFile,
                   .take = cli::into(command->file)},
                  {.name = "set",
                   .value = "KEY=VALUE",
                   .help = "Override the value of a key in the file; with a list of values, sweep over them",
                   .repeats = true,
                   .take = cli::into(command->settings)},
                  {.name = "output",
                   .letter = 'o',
                   .value = "FOLDER",
                   .help = "Folder for the results",
                   .standard = "NAME.runs",
                   .completes = cli::Option::Completes::kFolder,
                   .take = cli::into(command->results.folder)},
                  {.kind = cli::Option::Kind::kFlag,
                   .name = "resume",
                   .help = "Keep the runs of this experiment that the folder has, as an end before its time left them, "
                           "and make the others",
                   .take = cli::into(command->results.resume)},
                  {.kind = cli::Option::Kind::kFlag,
                   .name = "allow-outside",
                   .help = "Let the experiment's name, and links in the folder of the results, lead to other folders",
                   .take = cli::into(command->results.allow_outside)},
                  allow_code_option(command->allow_code),
                  {.kind = cli::Option::Kind::kFlag,
                   .name = "dry-run",
                   .help = "Print the experiment with all its values without running it",
                   .take = cli::into(command->dry)},
                  {.kind = cli::Option::Kind::kFlag,
                   .name = "quiet",
                   .help = "Print only errors",
                   .take = cli::into(command->quiet)}},
      .notes = "For the keys of a file, see: driftmesh config --keys",
      .examples = {"driftmesh run configs/first-run.yaml",
                   "driftmesh run configs/scaled-speedup.yaml --set 'cluster.ranks=[1,4,16]' -o few",
                   "mpirun -n 2 driftmesh run configs/two-ranks.yaml --set cluster.kind=real"},
      .exit_codes = "0 done, 1 error, 2 wrong usage, 3 stopped by a limit",
      .run = [command](cli::Call&) {
        run_experiment(*command);
        return 0;
      }};
}

}  // namespace driftmesh::app
