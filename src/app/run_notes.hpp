#pragma once

#include <string>
#include <type_traits>

#include "app/mesh_options.hpp"
#include "app/progress_line.hpp"
#include "app/run_record.hpp"
#include "base/stopwatch.hpp"
#include "pslg/pslg.hpp"

namespace driftmesh::app {

/// What is noted and shown of a run of `driftmesh mesh` while it goes on, in one mesh or in parts: the stages with
/// their times, progress, the record and its summary.
class RunNotes {
 public:
  /// `silent`: this is a rank that shows nothing, whatever the options say.
  RunNotes(const MeshOptions& options, std::string command, bool silent = false);

  RunRecord run;
  ProgressLine progress;

  /// Does `work` as a stage of this name.
  template <class Work>
  std::invoke_result_t<Work> timed(const char* stage, Work&& work) {
    progress.begin(stage);
    struct Note {  // also when work returns a value
      RunNotes& notes;
      const char* stage;
      Stopwatch watch{};
      ~Note() { notes.note(stage, watch.seconds()); }
    } note{*this, stage};
    return work();
  }
  void note(const char* stage, double seconds) { run.stages.push_back({stage, seconds}); }
  void note_file(const std::string& file);

  /// Repairs the input, and says so.
  void repair_input(Pslg& pslg);
  /// The summary, and the record where one is asked for.
  void finish();

 private:
  const MeshOptions& options_;
  bool quiet_;
  Stopwatch since_start_;
};

}  // namespace driftmesh::app
