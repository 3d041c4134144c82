#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>
#include <type_traits>
#include <utility>

#include "app/commands.hpp"
#include "app/config_file.hpp"
#include "app/limits.hpp"
#include "app/memory.hpp"
#include "app/mesh_options.hpp"
#include "app/output_files.hpp"
#include "app/progress_line.hpp"
#include "app/run_record.hpp"
#include "app/summary.hpp"
#include "base/atomic_file.hpp"
#include "base/error.hpp"
#include "base/stopwatch.hpp"
#include "mesh/interpolate_attributes.hpp"
#include "mesh/mesher.hpp"
#include "mesh/to_piece.hpp"
#include "output/mesh_file.hpp"
#include "output/plot.hpp"
#include "pslg/poly_file.hpp"
#include "pslg/repair.hpp"

namespace driftmesh::app {
namespace {

constexpr int kStoppedByLimit = 3;

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

/// One run: the stages in their order, and what is noted of each.
class MeshRun {
 public:
  MeshRun(const MeshOptions& options, std::string command)
      : options_(options), progress_(!options.quiet && ProgressLine::possible()) {
    run_.command = std::move(command);
    run_.input_file = options.input;
    run_.min_angle = options.angle;
    run_.max_area = options.area;
    run_.sizing = sizing_words(options.sizing);
  }

  /// The exit code.
  int go() {
    check_outputs(options_.outputs, options_.picture, options_.json, options_.input);
    Pslg pslg = timed("read", [&] { return read_poly(options_.input); });
    timed("repair", [&] { repair_input(pslg); });
    size_ = timed("size", [&] { return make_size_field(options_.sizing); });
    MeshResult result = mesh(pslg);
    timed("inspect", [&] { record_mesh(run_, result); });
    if (result.complete || options_.keep_incomplete) write(std::move(result), pslg);
    finish();
    if (result.complete) return 0;
    std::cerr << "driftmesh: " << stopped_message(limits_, run_.triangles, options_.keep_incomplete) << '\n';
    return kStoppedByLimit;
  }

 private:
  template <class Work>
  std::invoke_result_t<Work> timed(const char* stage, Work&& work) {
    progress_.begin(stage);
    struct Note {  // also when work returns a value
      MeshRun& run;
      const char* stage;
      Stopwatch watch{};
      ~Note() { run.note(stage, watch.seconds()); }
    } note{*this, stage};
    return work();
  }
  void note(const char* stage, double seconds) { run_.stages.push_back({stage, seconds}); }

  void repair_input(Pslg& pslg) {
    run_.repairs = repair(pslg, options_.input);
    run_.input_points = static_cast<std::int64_t>(pslg.points.size());
    run_.input_segments = static_cast<std::int64_t>(pslg.segments.size());
    run_.input_holes = static_cast<std::int64_t>(pslg.holes.size());
    run_.input_regions = static_cast<std::int64_t>(pslg.regions.size());
    if (!options_.quiet) progress_.write(run_.repairs.summary());
  }

  MeshResult mesh(const Pslg& pslg) {
    limits_ = find_limits(options_, pslg);
    MeshRequest request{options_.angle, options_.area, !options_.no_region_areas, size_.get(), limits_.triangles};
    progress_.begin("triangulate");
    MeshResult result = mesh_domain(pslg, request, [&](std::int64_t triangles, double forecast) {
      if (std::exchange(run_.forecast, forecast) == 0 && !options_.keep_incomplete) check_forecast(limits_, forecast);
      progress_.refining(triangles, forecast);
    });
    note("triangulate", result.seconds_triangulate);
    note("refine", result.seconds_refine);
    run_.seconds_refine = result.seconds_refine;
    run_.peak_refining = peak_memory();
    run_.stopped_by = limits_.option();
    return result;
  }

  void write(MeshResult&& result, const Pslg& pslg) {
    if (options_.outputs.empty() && options_.picture.empty()) return;
    const MeshPiece piece = timed("convert", [&] { return convert(std::move(result.mesh), pslg); });
    timed("write", [&] {
      for (const std::string& output : options_.outputs) write_mesh(piece, output, {pslg.holes});
    });
    for (const std::string& output : options_.outputs)
      for (const std::string& file : mesh_files(output)) note_file(file);
    if (options_.picture.empty()) return;
    const std::string title = std::filesystem::path(options_.input).filename().string();
    timed("plot", [&] { plot_mesh(piece, options_.picture, {.title = title}); });
    note_file(options_.picture);
  }
  void note_file(const std::string& file) { run_.files.push_back({file, std::filesystem::file_size(file)}); }

  static MeshPiece convert(Triangulation mesh, const Pslg& pslg) {
    MeshPiece piece = to_piece(mesh, pslg);
    interpolate_attributes(pslg, piece);
    return piece;
  }

  void finish() {
    run_.seconds = watch_.seconds();
    run_.peak = peak_memory();
    progress_.end();
    if (!options_.quiet) std::cout << summary_text(run_) << std::flush;
    if (options_.json.empty()) return;
    AtomicFile file(options_.json);
    file.write(summary_json(run_));
    file.commit();
  }

  const MeshOptions& options_;
  ProgressLine progress_;
  RunRecord run_;
  std::unique_ptr<SizeField> size_;
  Limits limits_;
  Stopwatch watch_;
};

int run_mesh(CLI::App& command, MeshOptions& options) {
  if (!options.config.empty()) apply_config(command, options.config);
  check_mesh_options(options);
  return MeshRun(options, command_line_of(command, {"config", "quiet"})).go();
}

}  // namespace

void add_mesh(CLI::App& program) {
  const auto options = std::make_shared<MeshOptions>();
  CLI::App* const command = program.add_subcommand("mesh", "Make a quality mesh of a domain");
  add_mesh_options(*command, *options);
  command->callback([command, options] {
    if (const int code = run_mesh(*command, *options); code != 0) throw CLI::RuntimeError(code);
  });
}

}  // namespace driftmesh::app
