#include "app/run_notes.hpp"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <utility>

#include "app/memory.hpp"
#include "app/summary.hpp"
#include "base/atomic_file.hpp"
#include "base/standard_streams.hpp"
#include "pslg/repair.hpp"

namespace driftmesh::app {
namespace {

std::string sizing_words(const SizingOptions& sizing) {
  std::string words;
  const auto add = [&](const std::string& what) { words += (words.empty() ? "" : ", ") + what; };
  if (!sizing.expression.empty()) add(sizing.expression);
  if (!sizing.background.empty()) add(sizing.background);
  if (sizing.gradation) add(fmt::format("gradation {}", *sizing.gradation));
  if (sizing.shortest > 0) add(fmt::format("at least {}", sizing.shortest));
  if (std::isfinite(sizing.longest)) add(fmt::format("at most {}", sizing.longest));
  return words;
}

}  // namespace

RunNotes::RunNotes(const MeshOptions& options, std::string command, bool silent)
    : progress(!silent && !options.quiet),
      options_(options),
      quiet_(silent || options.quiet) {
  run.command = std::move(command);
  run.input_file = options.input;
  run.min_angle = options.angle;
  run.max_area = options.area;
  run.sizing = sizing_words(options.sizing);
}

void RunNotes::note_file(const std::string& file) {
  if (is_standard_stream(file)) return;
  std::error_code unknown;  // of a pipe, or of a piece that the network file system does not show yet
  const std::uintmax_t size = std::filesystem::file_size(file, unknown);
  run.files.push_back({file, unknown ? 0 : size});
}

void RunNotes::repair_input(Pslg& pslg) {
  run.repairs = repair(pslg, options_.input);
  run.input_points = static_cast<std::int64_t>(pslg.points.size());
  run.input_segments = static_cast<std::int64_t>(pslg.segments.size());
  run.input_holes = static_cast<std::int64_t>(pslg.holes.size());
  run.input_regions = static_cast<std::int64_t>(pslg.regions.size());
  if (!quiet_) progress.write(run.repairs.summary());
}

void RunNotes::finish() {
  run.seconds = since_start_.seconds();
  run.peak = std::max(run.peak, peak_memory());
  progress.end();
  if (!options_.json.empty()) {
    AtomicFile file(options_.json);
    file.write(summary_json(run));
    file.commit();
  }
  if (!quiet_) print(summary_text(run));
}

}  // namespace driftmesh::app
