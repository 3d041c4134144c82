#pragma once

#include <string>
#include <vector>

#include "app/progress_line.hpp"
#include "base/staged_files.hpp"
#include "base/stopwatch.hpp"
#include "job/record.hpp"
#include "job/watch.hpp"

namespace driftmesh::app {

/// Records and shows a run of `driftmesh mesh` in progress: the stages with their times, progress, the record and its
/// summary.
class RunNotes final : public job::Watch {
 public:
  /// `command`: a command line that makes the same mesh. `silent`: this rank shows nothing, regardless of the request.
  RunNotes(const job::Request& request, std::string command, bool silent = false);

  job::RunRecord run;

  void begins(const std::string& stage) override { progress_.begin(stage); }
  void ends(const std::string& stage, double seconds) override { run.stages.push_back({stage, seconds}); }
  void repaired(const RepairReport& repairs) override;
  void warned(const std::string& warning) override;
  void refining(std::int64_t triangles, double forecast) override;
  void stalled(const std::string& why) override;

  /// The files of the mesh and its picture; those of `staged` have their size, pipes and devices none.
  void note_files(const std::vector<std::string>& files, const std::vector<StagedFiles::Listed>& staged);
  /// The work is done. Writes the record, if requested; it belongs to the files that are staged.
  void finish();
  /// Prints the summary.
  void show() const;

 private:
  job::Request::Output wanted_;
  bool silent_;
  ProgressLine progress_;
  Stopwatch since_start_;
};

}  // namespace driftmesh::app
