#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/experiment_run.hpp"

namespace driftmesh::app {

/// The results of an experiment's runs as a table.
class ExperimentTable {
 public:
  /// Adds a row for a finished run.
  void add(const ExperimentRun& run);

  /// All figures, comma-separated; the first line names the columns (see docs/experiments.md).
  [[nodiscard]] std::string csv() const;
  /// The most important figures in Markdown, aligned, one line per run.
  [[nodiscard]] std::string markdown() const;

  struct Row {
    std::string run;
    std::vector<std::pair<std::string, std::string>> swept;
    std::int32_t repetition = 0;
    std::string policy;
    std::size_t ranks = 0, subdomains = 0;
    std::int64_t triangles = 0;
    double seconds = 0;
    double ideal_seconds = 0;            ///< if every rank computed from start to end
    double rate = 0;                     ///< triangles per second
    double efficiency = 0;               ///< rate relative to the cluster's speed, normalized by the first run
    double cutting = 0;                  ///< seconds before these, in which rank 0 cuts the domain
    double efficiency_with_cutting = 0;  ///< the same of both times together
    RankTimes times;                     ///< of all ranks together, as fractions of ranks x seconds
    std::int64_t splits = 0, split_messages = 0, hand_offs = 0, hand_off_bytes = 0;
    std::uint64_t messages = 0, message_bytes = 0;
  };
  [[nodiscard]] const std::vector<Row>& rows() const { return rows_; }

  /// Of the time that perfect balance would save in the same run without balancing, the fraction that this run saves.
  /// Empty if there is no such run, or nothing to save.
  [[nodiscard]] std::optional<double> recovered(const Row& row) const;

 private:
  std::vector<Row> rows_;
  double first_rate_ = 0;  // relative to the cluster's speed
  double first_rate_with_cutting_ = 0;
};

}  // namespace driftmesh::app
