#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "study/experiment_run.hpp"

namespace driftmesh::study {

/// The results of an experiment's runs as a table.
class ExperimentTable {
 public:
  /// Adds a row for a finished run.
  void add(const ExperimentRun& run);

  /// All figures, comma-separated; the first line names the columns (see docs/experiments.md).
  [[nodiscard]] std::string csv() const;
  /// Adds the rows that a csv() has of these runs, of which it begins with some in this order, as far as they are
  /// whole.
  void add_rows(const std::string& csv, std::span<const ExperimentRun> runs);
  /// The most important figures in Markdown, aligned: a line for each point of the sweep, with the repetition whose
  /// time is the median. Columns that are the same everywhere stand below the table.
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
    double oracle_seconds = 0;           ///< with the best mapping of whole subdomains
    double efficiency = 0;               ///< ideal time over time
    double cutting = 0;                  ///< seconds before these, in which rank 0 cuts the domain
    double efficiency_with_cutting = 0;  ///< ideal time over both times together
    double spread = 0;                   ///< half the range of seconds over repetitions
    RankTimes times;                     ///< all ranks together, as fractions of ranks x seconds
    std::int64_t splits = 0, split_messages = 0, hand_offs = 0, hand_off_bytes = 0;
    std::uint64_t messages = 0, message_bytes = 0;
    std::int64_t whole_plans = 0, whole_plans_kept = 0;  ///< plans to be made as a whole; those of them that were
  };
  [[nodiscard]] const std::vector<Row>& rows() const { return rows_; }

 private:
  std::vector<Row> rows_;
};

/// How much later than an oracle the run ended, as a fraction of the oracle's time.
[[nodiscard]] double regret(const ExperimentTable::Row& row);

/// The fraction that this run saves of the time that perfect balance would save in the same run without balancing.
/// Empty if `rows` have no such run, if nothing is to be saved, and where noise explains the difference: nothing moved,
/// or the times differ by no more than they do between repetitions.
[[nodiscard]] std::optional<double> recovered(const ExperimentTable::Row& row,
                                              std::span<const ExperimentTable::Row> rows);

/// The median repetition of each point of the sweep.
[[nodiscard]] std::vector<ExperimentTable::Row> medians_of(std::span<const ExperimentTable::Row> rows);

}  // namespace driftmesh::study
