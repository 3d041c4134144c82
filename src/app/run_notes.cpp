#include "app/run_notes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
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

void RunNotes::refining(std::int64_t triangles, double forecast) {
  progress_.refining(triangles, forecast);
}

void RunNotes::stalled(const std::string& why) {
  fmt::print(stderr, "driftmesh: {}\n", why);
}

void RunNotes::note_file(const std::string& file) {
  if (is_standard_stream(file)) return;
  std::error_code unknown;  // for a pipe, or a piece that the network file system does not show yet
  const std::uintmax_t size = std::filesystem::file_size(file, unknown);
  run.files.push_back({file, unknown ? 0 : size});
}

void RunNotes::finish() {
  run.seconds = since_start_.seconds();
  run.peak = std::max(run.peak, job::peak_memory());
  progress_.end();
  if (!wanted_.record.empty()) {
    AtomicFile file(wanted_.record);
    file.write(summary_json(run));
    file.commit();
  }
  if (!silent_) print(summary_text(run));
}

}  // namespace driftmesh::app
