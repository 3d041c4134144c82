#include "app/mesh_run.hpp"

#include <algorithm>
#include <iostream>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "app/mesh_on_ranks.hpp"
#include "app/mesh_outputs.hpp"
#include "app/run_notes.hpp"
#include "app/subdomain_order.hpp"
#include "base/staged_files.hpp"
#include "distributed/exchange.hpp"
#include "distributed/piece_series.hpp"
#include "distributed/write_distributed.hpp"
#include "io/mesh_file.hpp"
#include "job/domain.hpp"
#include "job/limits.hpp"
#include "job/memory.hpp"
#include "job/one_piece.hpp"
#include "job/thread_run.hpp"
#include "job/triangulated.hpp"
#include "mesh/cdt.hpp"
#include "mesh/interpolate_attributes.hpp"
#include "mesh/to_piece.hpp"

namespace driftmesh::app {
namespace {

using job::Request;
using job::timed;

// ---- In one piece ----------------------------------------------------------------------------------------------

/// A whole mesh as the only piece. `numbered`: for a file in pieces.
DistributedPiece as_piece(Mesh mesh, bool numbered) {
  DistributedPiece piece;
  piece.has_regions = !mesh.regions.empty();
  if (numbered) {
    mesh.numbers.resize(mesh.points.size());
    std::iota(mesh.numbers.begin(), mesh.numbers.end(), 0);
    mesh.subdomains.resize(mesh.triangles.size());
    mesh.ranks.resize(mesh.triangles.size());
  }
  piece.mesh = std::move(mesh);
  return piece;
}

/// Calls write(path) for each .pvtu.
template <class Write>
void write_in_pieces(const Request& request, const Write& write) {
  for (const std::string& output : request.output.meshes)
    if (is_in_pieces(output)) write(output);
}

/// Writes the other formats, and draws.
void write_whole(const Request& request, Mesh& mesh, const std::vector<Point>& holes, RunNotes& notes) {
  mesh.numbers = {};
  mesh.ranks = {};
  timed(notes, "write", [&] {
    for (const std::string& output : request.output.meshes)
      if (!is_in_pieces(output)) write_mesh(mesh, output, writing_of(request, holes, notes));
  });
  if (!request.output.picture.empty()) timed(notes, "plot", [&] { draw(request, mesh); });
}

// By value, so that its memory is free before the mesh is written.
Mesh converted(Triangulation mesh, const job::Domain& domain) {  // NOLINT(performance-unnecessary-value-param)
  Mesh piece = to_piece(mesh, domain.pslg);
  interpolate_attributes(domain.pslg, piece);
  job::set_depths(domain.rasters, piece);
  return piece;
}

int mesh_in_one_piece(const Told& told, const job::Domain& domain, job::Triangulated&& triangulated, RunNotes& notes) {
  const Request& request = told.request;
  const std::vector<Point> holes = std::move(triangulated.holes);
  job::OnePiece made = job::mesh_in_one_piece(request, domain, std::move(triangulated), writes(request.output), notes);
  notes.run.forecast = made.forecast;
  notes.run.seconds_refine = made.result.seconds_refine;
  notes.run.peak_refining = job::peak_memory();
  notes.run.stopped_by = made.limits.called(made.by_memory);
  timed(notes, "inspect", [&] { job::record_mesh(notes.run, made.result); });
  const bool keep = request.limits.keep_incomplete;
  StagedFiles files;
  if (writes(request.output) && (made.result.complete || keep)) {
    Mesh mesh = timed(notes, "convert", [&] { return converted(std::move(made.result.mesh), domain); });
    const bool numbered = std::ranges::any_of(request.output.meshes, is_in_pieces);
    DistributedPiece piece = as_piece(std::move(mesh), numbered);
    if (numbered)
      timed(notes, "write", [&] {
        write_in_pieces(request, [&](const std::string& path) {
          WritePieces writing(piece, path);
          exchange_directly(IdVector<Rank, Exchange*>{&writing});
        });
      });
    if (writes_whole(request.output)) write_whole(request, piece.mesh, holes, notes);
    notes.note_files(files_written(request, 1), files.files());
  }
  notes.finish();
  files.commit();
  notes.show();
  if (notes.run.complete) return 0;
  made.result.mesh = {};  // its memory is needed
  const auto narrow = find_narrow_place(triangulate(domain.pslg));
  std::cerr << "driftmesh: " << job::stopped_message(made.limits, made.by_memory, notes.run.triangles, keep, narrow)
            << '\n';
  return job::kStoppedByLimit;
}

// ---- By threads ------------------------------------------------------------------------------------------------

void assemble_and_write(const Request& request, std::optional<job::ThreadRun>& run, RunNotes& notes) {
  if (std::ranges::any_of(request.output.meshes, is_in_pieces))
    timed(notes, "write", [&] {
      write_in_pieces(request, [&](const std::string& path) { run->write_pieces(path, request.output.ghost_layer); });
    });
  if (!writes_whole(request.output)) return;
  DistributedPiece piece = timed(notes, "assemble", [&] { return run->assemble(); });
  const std::vector<Point> holes = run->pslg().holes;
  run.reset();  // the subdomains are no longer needed
  write_whole(request, piece.mesh, holes, notes);
}

int mesh_by_threads(const Told& told, job::Domain&& domain, job::Triangulated&& triangulated, RunNotes& notes) {
  const Request& request = told.request;
  const std::int32_t threads = job::threads_of(request);
  job::Order order = order_of(request, std::move(domain), triangulated, job::kSubdomains,
                              IdVector<Rank, double>(to_index(threads), 1.0), {}, notes);
  triangulated = {};
  const std::int32_t pieces = PieceSeries::count(order.plan.decomposition);
  if (pieces > 1) register_files(told, pieces);
  reuse_memory(request.limits);
  std::optional<job::ThreadRun> run(std::in_place, std::move(order), threads, nullptr, notes);
  timed(notes, "refine", [&] { run->refine(); });
  timed(notes, "inspect", [&] { run->report(notes.run); });
  StagedFiles files;
  if (writes(request.output)) {
    assemble_and_write(request, run, notes);
    notes.note_files(files_written(request, pieces), files.files());
  }
  notes.finish();
  files.commit();
  notes.show();
  return 0;
}

// ---- In this process -------------------------------------------------------------------------------------------

int mesh_here(const Told& told, job::Place place) {
  const Request& request = told.request;
  for (const std::string& output : request.output.meshes)
    if (is_for_ranks(output))
      throw InputError({output}, "has a file for each rank of MPI", "start the program with mpirun, or write a .mesh");
  register_files(told, 1);
  RunNotes notes(request, told.command);
  job::cap_memory(request.limits);
  job::Domain domain = job::read_domain(request, {}, notes);
  job::record_domain(notes.run, request, domain);
  job::Triangulated triangulated = job::triangulate_domain(request, domain, 1, job::cut_of(request, place), notes);
  if (triangulated.cut) return mesh_by_threads(told, std::move(domain), std::move(triangulated), notes);
  return mesh_in_one_piece(told, domain, std::move(triangulated), notes);
}

}  // namespace

int run_mesh(const Request& request, job::Place place, const std::string& command, const std::string& config) {
  const Told told{request, command, config};
  return place == job::kRanks ? mesh_on_ranks(told) : mesh_here(told, place);
}

}  // namespace driftmesh::app
