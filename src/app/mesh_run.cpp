#include "app/mesh_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <numeric>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "app/lattice_run.hpp"
#include "app/run_files.hpp"
#include "app/run_notes.hpp"
#include "balancer/policies/policy_factory.hpp"
#include "base/keep_memory.hpp"
#include "base/staged_files.hpp"
#include "distributed/exchange.hpp"
#include "distributed/piece_series.hpp"
#include "distributed/write_distributed.hpp"
#include "io/mesh_file.hpp"
#include "job/check.hpp"
#include "job/domain.hpp"
#include "job/failure.hpp"
#include "job/files.hpp"
#include "job/memory.hpp"
#include "job/mpi/mpi_team.hpp"
#include "job/one_piece.hpp"
#include "job/order.hpp"
#include "job/outputs.hpp"
#include "job/prepare.hpp"
#include "job/rank_run.hpp"
#include "job/thread_run.hpp"
#include "job/triangulated.hpp"
#include "mesh/cdt.hpp"
#include "mesh/interpolate_attributes.hpp"
#include "mesh/to_piece.hpp"
#include "picture/plot.hpp"

namespace driftmesh::app {
namespace {

using job::Request;
using job::timed;

bool writes(const Request::Output& wanted) {
  return !wanted.meshes.empty() || !wanted.picture.empty();
}

/// What `driftmesh mesh` was told.
struct Told {
  const Request& request;
  const std::string& command;
  const std::string& config;
};

void register_files(const Told& told, std::int32_t ranks) {
  const auto called = [](const char* key) { return job::called(key, job::kMesh); };
  FileRegistry files;
  if (!told.config.empty()) files.reads(told.config, "--config");
  job::register_reads(told.request, job::kMesh, files);
  const Request::Output& wanted = told.request.output;
  for (const std::string& mesh : wanted.meshes) register_mesh_output(files, mesh, called("output.meshes"), ranks);
  register_picture(files, wanted.picture, called("output.picture"));
  register_output(files, wanted.record, called("output.record"));
}

bool writes_whole(const Request::Output& wanted) {
  return !wanted.picture.empty() || !std::ranges::all_of(wanted.meshes, is_in_pieces);
}

/// Whether rank 0 needs all of it.
bool gathers(const Request::Output& wanted) {
  return !wanted.picture.empty() || !std::ranges::all_of(wanted.meshes, is_written_by_all);
}

/// Of the mesh and its picture, but not the record.
std::vector<std::string> files_written(const Request& request, std::int32_t ranks) {
  std::vector<std::string> files;
  for (const std::string& mesh : request.output.meshes)
    for (const std::string& file : files_of_output(mesh, ranks)) files.push_back(file);
  if (!request.output.picture.empty()) files.push_back(request.output.picture);
  return files;
}

void draw(const Request& request, const Mesh& mesh) {
  const std::string title = std::filesystem::path(job::input_name(request)).filename().string();
  plot_mesh(mesh, request.output.picture, {.title = title});
}

// ---- The mesh of one process -----------------------------------------------------------------------------------

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

WriteOptions writing_of(const Request& request, const std::vector<Point>& holes) {
  const std::vector<double>& open = request.output.open_boundary;
  return {holes, request.output.ascii, {open.begin(), open.end()}, request.output.ghost_layer};
}

/// Writes the other formats, and draws.
void write_whole(const Request& request, Mesh& mesh, const std::vector<Point>& holes, RunNotes& notes) {
  mesh.numbers = {};
  mesh.ranks = {};
  timed(notes, "write", [&] {
    for (const std::string& output : request.output.meshes)
      if (!is_in_pieces(output)) write_mesh(mesh, output, writing_of(request, holes));
  });
  if (!request.output.picture.empty()) timed(notes, "plot", [&] { draw(request, mesh); });
}

// ---- In one piece ----------------------------------------------------------------------------------------------

// By value, so that its memory is free before the mesh is written.
Mesh converted(Triangulation mesh, const job::Domain& domain) {  // NOLINT(performance-unnecessary-value-param)
  Mesh piece = to_piece(mesh, domain.pslg);
  interpolate_attributes(domain.pslg, piece);
  job::set_depths(domain.rasters, piece);
  return piece;
}

int mesh_in_one_piece(const Told& told, const job::Domain& domain, job::Triangulated&& triangulated, RunNotes& notes) {
  const Request& request = told.request;
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
    if (writes_whole(request.output)) write_whole(request, piece.mesh, domain.pslg.holes, notes);
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

// ---- In subdomains ---------------------------------------------------------------------------------------------

job::Use use_in_subdomains(const Request& request, bool in_one_process) {
  return {.in_subdomains = true,
          .sleeps = request.run.sleep || !request.run.scratch.empty(),
          .stores = !request.run.scratch.empty(),
          .writes = writes(request.output),
          .gathers = gathers(request.output) && !in_one_process};
}

void check_capacity(const Request& request, const job::Prepared& prepared, const job::Use& use,
                    const job::Processes& processes) {
  double subdomain = 0;
  for (const Decomposition::Subdomain& s : prepared.plan.decomposition.subdomains)
    subdomain = std::max(subdomain, s.predicted);
  const double file = (processes.all == 1 ? writes_whole : gathers)(request.output)
                          ? prepared.forecast
                          : prepared.forecast * use.at_once / processes.all;
  job::check_capacity(subdomain, writes(request.output) ? file : 0, use.by);
}

/// For ranks, or threads, with these shares of their time.
job::Order order_of(const Request& request, job::Domain&& domain, const job::Triangulated& triangulated,
                    job::Place place, const IdVector<Rank, double>& shares, const job::Processes& processes,
                    RunNotes& notes) {
  job::Use use = use_in_subdomains(request, processes.all == 1);
  if (place == job::kSubdomains && !writes_whole(request.output))  // each thread a piece
    use.at_once = std::min(1.0, static_cast<double>(shares.size()) * kTrianglesInSeries / triangulated.forecast);
  job::Limits limits = job::find_limits(request.limits, domain.pslg, use, processes);
  if (triangulated.forecast > static_cast<double>(limits.in_memory)) {
    use.sleeps = true;
    limits = job::find_limits(request.limits, domain.pslg, use, processes);
  }
  job::Prepared prepared =
      job::prepare(request, domain, triangulated, {.policies = balancer::make_policy}, place, shares, limits, notes);
  check_capacity(request, prepared, use, processes);
  prepared.plan.work.sleep = use.sleeps;
  job::add_prepared(notes.run, prepared);
  return {std::move(prepared.plan), std::move(domain.pslg),   request.sizing, request.limits, shares, use,
          request.run.scratch,      std::move(domain.rasters)};
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

/// Every subdomain takes what the one before has freed. Under a ceiling, free memory counts as well as any other.
void reuse_memory(const Request::Limits& limits) {
  if (limits.max_memory == 0) keep_freed_memory();
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

// ---- On ranks --------------------------------------------------------------------------------------------------

/// mpirun binds each rank to a core or a few, unless it is told otherwise.
void warn_of_few_cores(const Request& request, RunNotes& notes) {
  const auto cores = static_cast<std::int64_t>(std::thread::hardware_concurrency());
  if (cores == 0 || request.run.threads <= cores) return;
  notes.warn(fmt::format("a rank has {} threads, but may use only {} of the cores; start it with mpirun --bind-to none",
                         request.run.threads, cores));
}

/// The part of rank 0 before the others start.
job::Order prepare_order(const Told& told, const job::Team& team, RunNotes& notes) {
  const Request& request = told.request;
  job::check_ranks(request, job::kRanks, team.ranks());
  register_files(told, team.ranks());
  job::cap_memory(request.limits);
  warn_of_few_cores(request, notes);
  job::Domain domain = job::read_domain(request, {}, notes);
  job::record_domain(notes.run, request, domain);
  const job::Triangulated triangulated =
      job::triangulate_domain(request, domain, team.ranks(), job::Cut::kAlways, notes);
  return order_of(request, std::move(domain), triangulated, job::kRanks, job::shares_of_time(request, team.ranks()),
                  job::processes_of(team), notes);
}

void report(job::Team& team, job::RankRun& run, RunNotes& notes) {
  job::RankReport own;
  timed(notes, "inspect", [&] { job::by_itself(team, [&] { own = run.report(); }); });
  job::gather_reports(team, own, notes.run);
  job::add_plan(notes.run, run.plan());
}

void write_pieces(const Request& request, const DistributedPiece& piece, ExchangeRunner& ranks,
                  const std::vector<Point>& holes, RunNotes& notes) {
  timed(notes, "write", [&] { write_distributed(ranks, piece, request.output.meshes, writing_of(request, holes)); });
  if (!request.output.picture.empty())
    timed(notes, "plot", [&] {
      GatherPieces gathering(piece);
      ranks.run(gathering);
      if (piece.rank == Rank{0}) draw(request, gathering.whole());
    });
}

void write_on_team(const Request& request, job::Team& team, const DistributedPiece& piece,
                   const std::vector<Point>& holes, RunNotes& notes) {
  const std::unique_ptr<job::Channel> channel = team.open();
  job::by_itself(team, [&] {
    ExchangeRunner ranks(channel->transport());
    write_pieces(request, piece, ranks, holes, notes);
  });
  channel->close();
}

void assemble_and_write(const Request& request, job::Team& team, std::optional<job::RankRun>& run, RunNotes& notes) {
  const std::unique_ptr<job::Channel> channel = team.open();
  job::by_itself(team, [&] {
    ExchangeRunner ranks(channel->transport());
    const DistributedPiece piece = timed(notes, "assemble", [&] { return run->assemble(ranks); });
    const std::vector<Point> holes = run->holes();
    run.reset();  // the subdomains are no longer needed
    write_pieces(request, piece, ranks, holes, notes);
  });
  channel->close();
}

/// The files appear, and the summary is shown, once all ranks are done.
void finish(job::Team& team, StagedFiles& files, RunNotes& notes) {
  job::agree(team, [&] {
    if (team.leads()) notes.finish();
  });
  job::commit(team, files);
  if (team.leads()) notes.show();
}

void mesh_by_lattice(const Told& told, job::Team& team) {
  const Request& request = told.request;
  RunNotes notes(request, "mpirun -n " + std::to_string(team.ranks()) + " " + told.command, !team.leads());
  job::agree(team, [&] {
    if (!team.leads()) return;
    job::check_ranks(request, job::kRanks, team.ranks());
    register_files(told, team.ranks());
  });
  job::cap_memory(request.limits);
  const job::Use use{.in_subdomains = true, .writes = writes(request.output), .gathers = gathers(request.output)};
  const BoundedDomain domain = share_domain(request, use, team, notes);
  const DistributedPiece piece = mesh_on_lattice(team, domain, notes);
  StagedFiles files;
  if (writes(request.output)) {
    write_on_team(request, team, piece, domain.pslg.holes, notes);
    notes.note_files(files_written(request, team.ranks()), job::staged_by_all(team, files));
  }
  finish(team, files, notes);
}

void mesh_on_team(const Told& told, job::Team& team) {
  const Request& request = told.request;
  if (request.run.method == job::Method::kPdr) return mesh_by_lattice(told, team);
  const std::string start = team.alone() ? "" : "mpirun -n " + std::to_string(team.ranks()) + " ";
  RunNotes notes(request, start + told.command, !team.leads());
  std::optional<job::Order> order = job::share(
      team, [&] { return std::optional(prepare_order(told, team, notes)); }, balancer::make_policy);
  job::cap_memory(order->limits);
  reuse_memory(order->limits);
  std::optional<job::RankRun> run(std::in_place, team, std::move(*order), nullptr, notes);
  timed(notes, "refine", [&] { run->refine(); });
  report(team, *run, notes);
  StagedFiles files;
  if (writes(request.output)) {
    assemble_and_write(request, team, run, notes);
    notes.note_files(files_written(request, team.ranks()), job::staged_by_all(team, files));
  }
  finish(team, files, notes);
}

int mesh_on_ranks(const Told& told) {
  const protocol::MpiSession session;
  job::MpiTeam team(protocol::MpiSession::world());
  try {
    mesh_on_team(told, team);
  } catch (const std::exception&) {
    if (team.leads()) throw;
    return 0;  // all ranks have the error, and rank 0 reports it
  }
  team.close();
  return 0;
}

}  // namespace

int run_mesh(const Request& request, job::Place place, const std::string& command, const std::string& config) {
  const Told told{request, command, config};
  return place == job::kRanks ? mesh_on_ranks(told) : mesh_here(told, place);
}

}  // namespace driftmesh::app
