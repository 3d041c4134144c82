#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "app/mesh_outputs.hpp"
#include "app/progress_line.hpp"
#include "base/staged_files.hpp"
#include "base/stopwatch.hpp"
#include "job/record.hpp"
#include "job/watch.hpp"

namespace driftmesh::app {

/// Records and shows a run of `driftmesh mesh` in progress: the stages with their times, progress, the record and its
/// summary. What is told must outlive it.
class RunNotes final : public job::Watch {
 public:
  /// `start`: begins the command line that makes the same mesh. `silent`: this rank shows nothing, whatever it is told.
  explicit RunNotes(const Told& told, const std::string& start = "", bool silent = false);

  job::RunRecord run;

  void begins(const std::string& stage) override { progress_.begin(stage); }
  /// Registers the files, if there are several pieces.
  void pieces(std::int32_t count) override;
  void repaired(const RepairReport& repairs) override;
  void warned(const std::string& warning) override;
  void refining(std::int64_t triangles, double forecast) override;
  void refining_on_all(std::int64_t triangles, double forecast) override { progress_.refining(triangles, forecast); }
  void writing(const std::string& path) override { progress_.writing(path); }
  void stalled(const std::string& why) override;

  /// The files of the mesh and its picture; those of `staged` have their size, pipes and devices none.
  void note_files(const std::vector<StagedFiles::Listed>& staged);
  /// The work is done. Writes the record, if requested; it belongs to the files that are staged.
  void finish();
  /// Prints the summary.
  void show() const;

 private:
  const Told& told_;
  bool silent_;
  bool on_ranks_;  // several
  std::int32_t pieces_ = 1;
  ProgressLine progress_;
  Stopwatch since_start_;
};

}  // namespace driftmesh::app
