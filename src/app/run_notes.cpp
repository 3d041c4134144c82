#include "app/run_notes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <utility>

#include "app/summary.hpp"
#include "base/atomic_file.hpp"
#include "base/standard_streams.hpp"
#include "job/memory.hpp"
#include "study/run_json.hpp"

namespace driftmesh::app {

RunNotes::RunNotes(const Told& told, const std::string& start, bool silent)
    : told_(told), silent_(silent || told.request.output.quiet), on_ranks_(!start.empty()), progress_(!silent_) {
  run.command = start + told.command;
}

void RunNotes::pieces(std::int32_t count) {
  pieces_ = count;
  if (count > 1) register_files(told_, count);
}

void RunNotes::repaired(const RepairReport& repairs) {
  if (!silent_) progress_.write(repairs.summary());
}

void RunNotes::warned(const std::string& warning) {
  if (!silent_) progress_.write("warning: " + warning + "\n");
}

void RunNotes::refining(std::int64_t triangles, double forecast) {
  if (!on_ranks_) progress_.refining(triangles, forecast);
}

void RunNotes::stalled(const std::string& why) {
  fmt::print(stderr, "driftmesh: {}\n", why);
}

void RunNotes::note_files(const std::vector<StagedFiles::Listed>& staged) {
  std::map<std::string, std::uint64_t> sizes;
  for (const StagedFiles::Listed& file : staged) sizes[file.path] = file.bytes;
  for (const std::string& file : files_written(told_.request, pieces_))
    if (!is_standard_stream(file)) run.files.push_back({file, sizes[file]});
}

void RunNotes::finish() {
  run.seconds = since_start_.seconds();
  run.warnings = take_warnings();
  run.stages = take_stages();
  run.peak = std::max(run.peak, job::peak_memory());
  progress_.end();
  const std::string& record = told_.request.output.record;
  if (record.empty()) return;
  AtomicFile file(record);
  file.write(study::run_json(run));
  file.commit();
}

void RunNotes::show() const {
  if (!silent_) print(summary_text(run));
}

}  // namespace driftmesh::app
