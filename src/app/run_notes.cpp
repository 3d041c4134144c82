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

namespace driftmesh::app {

RunNotes::RunNotes(const job::Request& request, std::string command, bool silent)
    : wanted_(request.output), silent_(silent || request.output.quiet), progress_(!silent_) {
  run.command = std::move(command);
}

void RunNotes::repaired(const RepairReport& repairs) {
  if (!silent_) progress_.write(repairs.summary());
}

void RunNotes::warned(const std::string& warning) {
  if (!silent_) progress_.write("warning: " + warning + "\n");
}

void RunNotes::refining(std::int64_t triangles, double forecast) {
  progress_.refining(triangles, forecast);
}

void RunNotes::stalled(const std::string& why) {
  fmt::print(stderr, "driftmesh: {}\n", why);
}

void RunNotes::note_files(const std::vector<std::string>& files, const std::vector<StagedFiles::Listed>& staged) {
  std::map<std::string, std::uint64_t> sizes;
  for (const StagedFiles::Listed& file : staged) sizes[file.path] = file.bytes;
  for (const std::string& file : files)
    if (!is_standard_stream(file)) run.files.push_back({file, sizes[file]});
}

void RunNotes::finish() {
  run.seconds = since_start_.seconds();
  run.warnings = take_warnings();
  run.peak = std::max(run.peak, job::peak_memory());
  progress_.end();
  if (wanted_.record.empty()) return;
  AtomicFile file(wanted_.record);
  file.write(summary_json(run));
  file.commit();
}

void RunNotes::show() const {
  if (!silent_) print(summary_text(run));
}

}  // namespace driftmesh::app
