#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/commands.hpp"
#include "app/experiment_pictures.hpp"
#include "app/experiment_run.hpp"
#include "app/experiment_table.hpp"
#include "app/lb_statistics.hpp"
#include "app/progress_line.hpp"
#include "app/real_cluster.hpp"
#include "base/atomic_file.hpp"
#include "base/error.hpp"
#include "experiment/key_words.hpp"
#include "protocol/mpi/mpi_transport.hpp"

namespace driftmesh::app {
namespace {

struct RunCommand {
  std::string file;
  std::vector<std::string> settings;
  std::string folder;
  bool dry = false;
  bool quiet = false;
};

void write_file(const std::filesystem::path& path, const std::string& text) {
  AtomicFile file(path.string());
  file.write(text);
  file.commit();
}

void make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw FileError(folder.string(), "cannot be made: " + error.message());
}

void write_lb_statistics(const ExperimentRun& run, const std::filesystem::path& folder) {
  make_folder(folder);
  std::size_t rank = 0;
  for (const std::string& text : lb_statistics(run)) write_file(folder / fmt::format("data.{}.json", rank++), text);
}

/// All runs of one experiment, one after the other.
class Runner {
 public:
  /// `cluster`: for real ranks; null if none of the runs needs them.
  Runner(const RunCommand& command, const experiment::ExperimentFile& file, RealCluster* cluster)
      : command_(command),
        file_(file),
        cluster_(cluster),
        folder_(command.folder.empty() ? file.base.name + ".runs" : command.folder),
        progress_(!command.quiet && ProgressLine::possible()) {}

  void go() {
    make_folder(folder_);
    write_file(folder_ / "experiment.yaml", experiment::experiment_text(file_));
    const std::size_t repetitions = static_cast<std::size_t>(file_.base.repetitions);
    const std::size_t runs = file_.points.size() * repetitions;
    for (std::size_t i = 0; i < runs; ++i) {
      progress_.begin(fmt::format("run {} of {}", i + 1, runs));
      do_run(fmt::format("run-{:0{}}", i + 1, std::to_string(runs).size()), file_.points[i / repetitions],
             static_cast<std::int32_t>(i % repetitions));
    }
    if (file_.base.pictures) draw_sweep(table_, file_.base.name, folder_.string());
    progress_.end();
    if (!command_.quiet) std::cout << table_.markdown() << "\nresults in " << folder_.string() << "/\n";
  }

 private:
  void do_run(const std::string& name, const experiment::SweepPoint& point, std::int32_t repetition) {
    ExperimentRun run;
    run.name = name;
    run.swept = point.values;
    run.repetition = repetition;
    run.experiment = point.experiment;
    run.experiment.seed += repetition;
    run.record.command = fmt::format("driftmesh run {}", command_.file);
    for (const std::string& setting : command_.settings) run.record.command += fmt::format(" --set '{}'", setting);
    make_run(run, cluster_, [&](std::int64_t triangles, double forecast) { progress_.refining(triangles, forecast); });
    write_file(folder_ / (name + ".json"), experiment_record(run));
    if (run.experiment.pictures) {
      draw_run(run, folder_.string());
      write_file(folder_ / (name + ".trace.json"), chrome_trace(run));
    }
    if (run.experiment.lb_phases > 0) write_lb_statistics(run, folder_ / (name + ".lb-stats"));
    table_.add(run);
    write_file(folder_ / "table.csv", table_.csv());
  }

  const RunCommand& command_;
  const experiment::ExperimentFile& file_;
  RealCluster* cluster_;
  std::filesystem::path folder_;
  ProgressLine progress_;
  ExperimentTable table_;
};

bool needs_real_ranks(const experiment::ExperimentFile& file) {
  return std::any_of(file.points.begin(), file.points.end(),
                     [](const experiment::SweepPoint& point) { return point.experiment.cluster == "real"; });
}

void run_experiment(const RunCommand& command) {
  std::optional<RealCluster> cluster;
  if (protocol::MpiSession::launched_as()) cluster.emplace();
  if (cluster && !cluster->leads()) return cluster->serve();
  const experiment::ExperimentFile file = experiment::read_experiment(command.file, command.settings);
  const auto runs = file.points.size() * static_cast<std::size_t>(file.base.repetitions);
  if (command.dry) {
    std::cout << experiment::experiment_text(file) << "# " << runs << (runs == 1 ? " run\n" : " runs\n");
    return;
  }
  experiment::check_processes(file, cluster ? cluster->ranks() : 1);
  if (!cluster && needs_real_ranks(file)) cluster.emplace();
  Runner(command, file, cluster ? &*cluster : nullptr).go();
}

}  // namespace

void add_run(CLI::App& program) {
  CLI::App* command = program.add_subcommand("run", "Do the experiment that a file describes");
  const auto request = std::make_shared<RunCommand>();
  command->add_option("experiment", request->file, "The experiment")->required()->type_name("FILE.yaml");
  command
      ->add_option("--set", request->settings,
                   "A key with another value than the file gives it; with a list of values, one to sweep over")
      ->allow_extra_args(false)
      ->type_name("KEY=VALUE");
  command->add_option("-o,--output", request->folder, "Folder for the results (by default NAME.runs)")
      ->type_name("FOLDER");
  command->add_flag("--dry-run", request->dry, "Print the experiment with all its values, and run nothing");
  command->add_flag("--quiet", request->quiet, "Print nothing but errors");
  command->footer(
      "Examples:\n"
      "  driftmesh run configs/first-run.yaml\n"
      "  driftmesh run configs/scaled-speedup.yaml --set 'cluster.ranks=[1,4,16]' -o few\n"
      "  mpirun -n 2 driftmesh run configs/two-ranks.yaml --set cluster.kind=real\n"
      "What an experiment can say: driftmesh config --keys\n"
      "Exit code: 0 done, 1 error, 2 wrong usage, 3 stopped by a limit.");
  command->callback([request] { run_experiment(*request); });
}

void add_config(CLI::App& program) {
  CLI::App* command = program.add_subcommand("config", "What the files of experiments can say");
  struct Wanted {
    bool schema = false, keys = false;
  };
  const auto wanted = std::make_shared<Wanted>();
  command->add_flag("--schema", wanted->schema,
                    "Print the JSON schema, for editors that check YAML while it is written");
  command->add_flag("--keys", wanted->keys, "Print all keys as a table in Markdown");
  command->require_option(1);
  command->footer(
      "Example:\n"
      "  driftmesh config --schema > experiment.schema.json\n"
      "Exit code: 0 done, 2 wrong usage.");
  command->callback(
      [wanted] { std::cout << (wanted->schema ? experiment::json_schema() : experiment::keys_table()) << std::flush; });
}

}  // namespace driftmesh::app
