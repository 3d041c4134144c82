#include <filesystem>
#include <iostream>
#include <memory>
#include <utility>

#include "app/commands.hpp"
#include "app/config_file.hpp"
#include "app/limits.hpp"
#include "app/memory.hpp"
#include "app/mesh_options.hpp"
#include "app/output_files.hpp"
#include "app/parallel_mesh.hpp"
#include "app/run_notes.hpp"
#include "io/mesh_file.hpp"
#include "mesh/cdt.hpp"
#include "mesh/interpolate_attributes.hpp"
#include "mesh/mesher.hpp"
#include "mesh/narrow_place.hpp"
#include "mesh/to_piece.hpp"
#include "picture/plot.hpp"
#include "protocol/mpi/mpi_transport.hpp"
#include "pslg/poly_file.hpp"

namespace driftmesh::app {
namespace {

/// One run on the domain as a whole: the stages in their order.
class MeshRun {
 public:
  MeshRun(const MeshOptions& options, std::string command) : options_(options), notes_(options, std::move(command)) {}

  /// The exit code.
  int go() {
    check_outputs(options_.outputs, options_.picture, options_.json, options_.input);
    Pslg pslg = notes_.timed("read", [&] { return read_poly(options_.input); });
    notes_.timed("repair", [&] { notes_.repair_input(pslg); });
    size_ = notes_.timed("size", [&] { return make_size_field(options_.sizing); });
    MeshResult result = mesh(pslg);
    notes_.timed("inspect", [&] { record_mesh(run_, result); });
    if (result.complete || options_.keep_incomplete) write(std::move(result), pslg);
    notes_.finish();
    if (run_.complete) return 0;
    const auto narrow = find_narrow_place(triangulate(pslg));
    std::cerr << "driftmesh: " << stopped_message(limits_, run_.triangles, options_.keep_incomplete, narrow) << '\n';
    return kStoppedByLimit;
  }

 private:
  MeshResult mesh(const Pslg& pslg) {
    limits_ = find_limits(options_, pslg);
    MeshRequest request{options_.angle, options_.area, !options_.no_region_areas, size_.get(), limits_.triangles};
    notes_.progress.begin("triangulate");
    MeshResult result = mesh_domain(pslg, request, [&](std::int64_t triangles, double forecast) {
      if (std::exchange(run_.forecast, forecast) == 0 && !options_.keep_incomplete) check_forecast(limits_, forecast);
      notes_.progress.refining(triangles, forecast);
    });
    notes_.note("triangulate", result.seconds_triangulate);
    notes_.note("refine", result.seconds_refine);
    run_.seconds_refine = result.seconds_refine;
    run_.peak_refining = peak_memory();
    run_.stopped_by = limits_.option();
    return result;
  }

  void write(MeshResult&& result, const Pslg& pslg) {
    if (options_.outputs.empty() && options_.picture.empty()) return;
    const MeshPiece piece = notes_.timed("convert", [&] { return convert(std::move(result.mesh), pslg); });
    notes_.timed("write", [&] {
      for (const std::string& output : options_.outputs) write_mesh(piece, output, {pslg.holes});
    });
    for (const std::string& output : options_.outputs)
      for (const std::string& file : mesh_files(output)) notes_.note_file(file);
    if (options_.picture.empty()) return;
    const std::string title = std::filesystem::path(options_.input).filename().string();
    notes_.timed("plot", [&] { plot_mesh(piece, options_.picture, {.title = title}); });
    notes_.note_file(options_.picture);
  }

  static MeshPiece convert(Triangulation mesh, const Pslg& pslg) {
    MeshPiece piece = to_piece(mesh, pslg);
    interpolate_attributes(pslg, piece);
    return piece;
  }

  const MeshOptions& options_;
  RunNotes notes_;
  RunRecord& run_ = notes_.run;
  std::unique_ptr<SizeField> size_;
  Limits limits_;
};

int run_mesh(cli::Call& call, const MeshOptions& options) {
  if (!options.config.empty()) apply_config(call, options.config);
  check_mesh_options(options);
  const std::string line = call.text({"config", "quiet"});
  if (protocol::MpiSession::launched_as() || options.parts.wanted()) return mesh_in_parts(options, line);
  return MeshRun(options, line).go();
}

}  // namespace

cli::Command mesh_command() {
  const auto options = std::make_shared<MeshOptions>();
  return {.name = "mesh",
          .summary = "Make a quality mesh of a domain",
          .options = mesh_options(*options),
          .notes = "Check a mesh with: driftmesh check bay.vtu bay.poly --angle 20 --area 5000",
          .examples = {"driftmesh mesh bay.poly --area 5000 -o bay.vtu --plot bay.png",
                       "driftmesh mesh bay.poly --angle 30 -o bay.msh -o bay.ele",
                       "driftmesh mesh bay.poly --size \"20 + 0.1*abs(x)\" --json run.json",
                       "mpirun -n 4 driftmesh mesh bay.poly --area 50 -o bay.pvtu"},
          .exit_codes = "0 done, 1 error, 2 wrong usage, 3 stopped by a limit",
          .run = [options](cli::Call& call) { return run_mesh(call, *options); }};
}

}  // namespace driftmesh::app
