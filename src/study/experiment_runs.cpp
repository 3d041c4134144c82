#include "study/experiment_runs.hpp"

#include <fmt/format.h>

#include <regex>
#include <utility>
#include <vector>

#include "base/atomic_file.hpp"
#include "base/file_identity.hpp"
#include "base/file_registry.hpp"
#include "base/read_file.hpp"
#include "base/staged_files.hpp"
#include "config/words.hpp"
#include "driftmesh/error.hpp"
#include "job/check.hpp"
#include "job/files.hpp"
#include "report/report_page.hpp"
#include "study/chrome_trace.hpp"
#include "study/decision_log.hpp"
#include "study/lb_statistics.hpp"
#include "study/run_report.hpp"

namespace driftmesh::study {
namespace {

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

}  // namespace

ExperimentRuns::ExperimentRuns(const config::Experiment& file, std::string command, const Options& options,
                               RealCluster* cluster)
    : file_(file),
      command_(std::move(command)),
      folder_(options.folder.empty() ? file.base.name + ".runs" : options.folder),
      named_(!options.folder.empty()),
      allow_outside_(options.allow_outside),
      cluster_(cluster) {
  register_files();
  make_folder(folder_);
  if (options.resume)
    take_earlier_results();
  else
    remove_earlier_results(folder_);
  write_file(folder_ / kExperimentFile, config::experiment_text(file_));
}

/// The table is written after all else of a run, so what it has is whole.
void ExperimentRuns::take_earlier_results() {
  const std::string experiment = (folder_ / kExperimentFile).string(), table = (folder_ / kTableFile).string();
  if (!std::filesystem::exists(experiment)) return;
  if (read_file(experiment) != config::experiment_text(file_))
    throw InputError({experiment}, "is not what is to be run now, so that its runs cannot be resumed",
                     "run it as it was, or leave out --resume, which removes them");
  if (!std::filesystem::exists(table)) return;
  std::vector<ExperimentRun> runs;
  for (std::size_t i = 0; i < size(); ++i) runs.push_back(run_before(i));
  table_.add_rows(read_file(table), runs);
}

std::string ExperimentRuns::name_of(std::size_t run) const {
  return fmt::format("run-{:0{}}", run + 1, std::to_string(size()).size());
}

void ExperimentRuns::register_files() const {
  FileRegistry files;
  files.reads(file_.path, "the experiment");
  for (const config::SweepPoint& point : file_.points) job::register_reads(point.request, job::kExperiment, files);
  if (!named_) require_inside(folder_.string(), ".");
  const auto writes = [&](const std::string& file) {
    const std::string path = (folder_ / file).string();
    require_inside(path, folder_.string());
    files.writes(path, "the results");
  };
  for (const char* file : {kExperimentFile, kTableFile, kPageFile}) writes(file);
  for (std::size_t i = 0; i < size(); ++i) {
    const std::string name = name_of(i);
    writes(name + kRecordEnding);
    writes(name + kDecisionsEnding);
    writes(name + kTraceEnding);
    for (std::int32_t r = 0; r < ranks_of_statistics(point_of(i).request); ++r)
      writes(name + kStatisticsEnding + "/" + statistics_file(r));
  }
}

/// What an experiment writes stays where the user expects it: names come from its file, and links from anybody.
void ExperimentRuns::require_inside(const std::string& path, const std::string& folder) const {
  if (allow_outside_ || lies_within(path, folder)) return;
  throw InputError({path}, "the results would be written outside of " + (folder == "." ? "this folder" : folder),
                   "give another name, name a folder with --output, or allow it with --allow-outside");
}

std::int32_t ExperimentRuns::ranks_of_statistics(const job::Request& request) const {
  if (request.lb_phases == 0) return 0;
  return request.cluster.kind == job::ClusterKind::kReal ? cluster_->ranks() : ranks_of(job::cluster_of(request));
}

ExperimentRun ExperimentRuns::run_before(std::size_t i) const {
  ExperimentRun run;
  run.name = name_of(i);
  run.swept = point_of(i).values;
  run.repetition = static_cast<std::int32_t>(i % repetitions());
  run.request = point_of(i).request;
  run.request.seed += run.repetition;
  run.record.command = command_;
  return run;
}

void ExperimentRuns::make(std::size_t i, job::Watch& watch) {
  ExperimentRun run = run_before(i);
  make_run(run, cluster_, watch);
  write(run);
}

void ExperimentRuns::write(const ExperimentRun& run) {
  StagedFiles files;
  write_file(folder_ / (run.name + kRecordEnding), experiment_record(run));
  write_file(folder_ / (run.name + kDecisionsEnding), decision_lines(run.outcome));
  if (run.request.report) write_file(folder_ / (run.name + kTraceEnding), chrome_trace(run.outcome));
  if (run.request.lb_phases > 0) write_lb_statistics(run, folder_ / (run.name + kStatisticsEnding));
  table_.add(run);
  write_file(folder_ / kTableFile, table_.csv());
  files.commit();
}

std::optional<std::filesystem::path> ExperimentRuns::report() const {
  if (!file_.base.report || !has_report_page()) return {};
  const std::filesystem::path page = folder_ / kPageFile;
  write_report(page.string(), records_of({folder_.string()}), {});
  return page;
}

}  // namespace driftmesh::study
