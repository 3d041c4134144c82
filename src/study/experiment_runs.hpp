#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "config/experiment.hpp"
#include "job/watch.hpp"
#include "study/experiment_table.hpp"
#include "study/real_cluster.hpp"

namespace driftmesh::study {

/// The runs of an experiment, made one after the other, and the folder of their results.
class ExperimentRuns {
 public:
  struct Options {
    std::string folder{};        ///< if empty, one that is named after the experiment
    bool resume = false;         ///< runs of this experiment that the folder has are not made again
    bool allow_outside = false;  ///< results may lie elsewhere than their names say
  };
  /// Registers all files, and removes what an earlier experiment left in the folder. `command`: for the records.
  /// `cluster`: for real ranks; null if none of the runs needs them. `file` and `cluster` outlive the object. Throws
  /// InputError if a result would overwrite an input, lie elsewhere, or take the place of what another experiment left
  /// that was to be resumed; FileError if there can be no such folder.
  ExperimentRuns(const config::Experiment& file, std::string command, const Options& options, RealCluster* cluster);

  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }
  [[nodiscard]] std::size_t size() const { return file_.points.size() * repetitions(); }
  /// How many of them there are already: the first ones.
  [[nodiscard]] std::size_t made() const { return table_.rows().size(); }
  /// Makes a run, the one after those that there are, and writes what comes of it. Throws what make_run throws.
  void make(std::size_t run, job::Watch& watch);
  /// The runs made so far.
  [[nodiscard]] const ExperimentTable& table() const { return table_; }
  /// Writes a page of all runs and returns its path, if the experiment asks for it and this program can.
  [[nodiscard]] std::optional<std::filesystem::path> report() const;

 private:
  [[nodiscard]] std::size_t repetitions() const { return static_cast<std::size_t>(file_.base.repetitions); }
  [[nodiscard]] const config::SweepPoint& point_of(std::size_t run) const { return file_.points[run / repetitions()]; }
  [[nodiscard]] std::string name_of(std::size_t run) const;
  void register_files() const;
  [[nodiscard]] ExperimentRun run_before(std::size_t run) const;
  void take_earlier_results();
  void require_inside(const std::string& path, const std::string& folder) const;
  [[nodiscard]] std::int32_t ranks_of_statistics(const job::Request& request) const;
  void write(const ExperimentRun& run);

  const config::Experiment& file_;
  std::string command_;
  std::filesystem::path folder_;
  bool named_;
  bool allow_outside_;
  RealCluster* cluster_;
  ExperimentTable table_;
};

}  // namespace driftmesh::study
