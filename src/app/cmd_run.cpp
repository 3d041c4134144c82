#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "app/chrome_trace.hpp"
#include "app/commands.hpp"
#include "app/decision_log.hpp"
#include "app/experiment_run.hpp"
#include "app/experiment_table.hpp"
#include "app/lb_statistics.hpp"
#include "app/progress_line.hpp"
#include "app/real_cluster.hpp"
#include "app/run_files.hpp"
#include "app/run_report.hpp"
#include "base/atomic_file.hpp"
#include "base/file_identity.hpp"
#include "base/file_registry.hpp"
#include "base/staged_files.hpp"
#include "base/standard_streams.hpp"
#include "cli/values.hpp"
#include "config/words.hpp"
#include "driftmesh/error.hpp"
#include "job/check.hpp"
#include "job/files.hpp"
#include "protocol/mpi/mpi_transport.hpp"

namespace driftmesh::app {
namespace {

struct RunCommand {
  std::string file;
  std::vector<std::string> settings;
  std::string folder;
  bool allow_outside = false;
  bool allow_code = false;
  bool dry = false;
  bool quiet = false;
};

// In the folder of the results; endings follow the name of a run.
constexpr const char *kExperimentFile = "experiment.yaml", *kTableFile = "table.csv", *kPageFile = "report.html",
                     *kRecordEnding = ".json", *kDecisionsEnding = ".decisions.jsonl", *kStatisticsEnding = ".lb-stats";

std::string statistics_file(std::int32_t rank) {
  return fmt::format("data.{}.json", rank);
}

void write_file(const std::filesystem::path& path, const std::string& text) {
  AtomicFile file(path.string());
  file.write(text);
  file.commit();
}

void make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw FileError(folder.string(), "cannot be created: " + error.message());
}

/// Removes what an earlier experiment left in its folder, so that no record there belongs to another experiment than
/// the table. A folder without an experiment is not touched.
void remove_earlier_results(const std::filesystem::path& folder) {
  static const std::regex of_a_run(R"(run-\d+(\.json|\.decisions\.jsonl|\.trace\.json|\.lb-stats))");
  std::error_code ignored;
  if (!std::filesystem::exists(folder / kExperimentFile, ignored)) return;
  std::vector<std::filesystem::path> stale{folder / kTableFile, folder / kPageFile};
  for (const auto& entry : std::filesystem::directory_iterator(folder, ignored))
    if (std::regex_match(entry.path().filename().string(), of_a_run)) stale.push_back(entry.path());
  for (const auto& path : stale) std::filesystem::remove_all(path, ignored);
}

void write_lb_statistics(const ExperimentRun& run, const std::filesystem::path& folder) {
  make_folder(folder);
  std::int32_t rank = 0;
  for (const std::string& text : lb_statistics(run)) write_file(folder / statistics_file(rank++), text);
}

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

/// All runs of one experiment, one after the other.
class Runner {
 public:
  /// `cluster`: for real ranks; null if none of the runs needs them.
  Runner(const RunCommand& command, const config::Experiment& file, RealCluster* cluster)
      : command_(command),
        file_(file),
        cluster_(cluster),
        folder_(command.folder.empty() ? file.base.name + ".runs" : command.folder),
        progress_(!command.quiet) {}

  void go() {
    register_files();
    make_folder(folder_);
    remove_earlier_results(folder_);
    write_file(folder_ / kExperimentFile, config::experiment_text(file_));
    for (std::size_t i = 0; i < runs(); ++i) {
      progress_.begin(fmt::format("run {} of {}", i + 1, runs()));
      do_run(name_of(i), point_of(i), static_cast<std::int32_t>(i % repetitions()));
    }
    const bool reported = file_.base.report && has_report_page();
    if (reported) write_report((folder_ / kPageFile).string(), records_of({folder_.string()}), {});
    progress_.end();
    if (!command_.quiet)
      print(table_.markdown() + "\nresults in " + folder_.string() + "/" +
            (reported ? fmt::format("; open {} in a browser", (folder_ / kPageFile).string()) : "") + "\n");
  }

 private:
  [[nodiscard]] std::size_t repetitions() const { return static_cast<std::size_t>(file_.base.repetitions); }
  [[nodiscard]] std::size_t runs() const { return file_.points.size() * repetitions(); }
  [[nodiscard]] const config::SweepPoint& point_of(std::size_t run) const { return file_.points[run / repetitions()]; }
  [[nodiscard]] std::string name_of(std::size_t run) const {
    return fmt::format("run-{:0{}}", run + 1, std::to_string(runs()).size());
  }

  void register_files() const {
    FileRegistry files;
    files.reads(command_.file, "the experiment");
    for (const config::SweepPoint& point : file_.points) job::register_reads(point.request, job::kExperiment, files);
    if (command_.folder.empty()) require_inside(folder_.string(), ".");
    const auto writes = [&](const std::string& file) {
      const std::string path = (folder_ / file).string();
      require_inside(path, folder_.string());
      files.writes(path, "the results");
    };
    for (const char* file : {kExperimentFile, kTableFile, kPageFile}) writes(file);
    for (std::size_t i = 0; i < runs(); ++i) {
      const std::string name = name_of(i);
      writes(name + kRecordEnding);
      writes(name + kDecisionsEnding);
      writes(name + kTraceEnding);
      for (std::int32_t r = 0; r < ranks_of_statistics(point_of(i).request); ++r)
        writes(name + kStatisticsEnding + "/" + statistics_file(r));
    }
  }

  /// What an experiment writes stays where the user expects it: names come from its file, and links from anybody.
  void require_inside(const std::string& path, const std::string& folder) const {
    if (command_.allow_outside || lies_within(path, folder)) return;
    throw InputError({path}, "the results would be written outside of " + (folder == "." ? "this folder" : folder),
                     "give another name, name a folder with --output, or allow it with --allow-outside");
  }

  [[nodiscard]] std::int32_t ranks_of_statistics(const job::Request& request) const {
    if (request.lb_phases == 0) return 0;
    return request.cluster.kind == job::ClusterKind::kReal ? cluster_->ranks() : ranks_of(job::cluster_of(request));
  }

  void do_run(const std::string& name, const config::SweepPoint& point, std::int32_t repetition) {
    ExperimentRun run;
    run.name = name;
    run.swept = point.values;
    run.repetition = repetition;
    run.request = point.request;
    run.request.seed += repetition;
    run.record.command = fmt::format("driftmesh run {}", command_.file);
    for (const std::string& setting : command_.settings) run.record.command += fmt::format(" --set '{}'", setting);
    make_run(run, cluster_, view_);
    StagedFiles files;
    write_file(folder_ / (name + kRecordEnding), experiment_record(run));
    write_file(folder_ / (name + kDecisionsEnding), decision_lines(run.outcome));
    if (run.request.report) write_file(folder_ / (name + kTraceEnding), chrome_trace(run.outcome));
    if (run.request.lb_phases > 0) write_lb_statistics(run, folder_ / (name + kStatisticsEnding));
    table_.add(run);
    write_file(folder_ / kTableFile, table_.csv());
    files.commit();
  }

  const RunCommand& command_;
  const config::Experiment& file_;
  RealCluster* cluster_;
  std::filesystem::path folder_;
  ProgressLine progress_;
  RunView view_{progress_};
  ExperimentTable table_;
};

bool needs_real_ranks(const config::Experiment& file) {
  return std::any_of(file.points.begin(), file.points.end(), [](const config::SweepPoint& point) {
    return point.request.cluster.kind == job::ClusterKind::kReal;
  });
}

void run_experiment(const RunCommand& command) {
  std::optional<RealCluster> cluster;
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
  Runner(command, file, cluster ? &*cluster : nullptr).go();
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
                   .take = cli::into(command->folder)},
                  {.kind = cli::Option::Kind::kFlag,
                   .name = "allow-outside",
                   .help = "Let the experiment's name, and links in the folder of the results, lead to other folders",
                   .take = cli::into(command->allow_outside)},
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
