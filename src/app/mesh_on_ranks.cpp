#include "app/mesh_on_ranks.hpp"

#include <fmt/format.h>

#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "app/lattice_run.hpp"
#include "app/run_notes.hpp"
#include "app/subdomain_order.hpp"
#include "balancer/policies/policy_factory.hpp"
#include "base/staged_files.hpp"
#include "distributed/exchange.hpp"
#include "distributed/write_distributed.hpp"
#include "job/check.hpp"
#include "job/domain.hpp"
#include "job/failure.hpp"
#include "job/limits.hpp"
#include "job/mpi/mpi_team.hpp"
#include "job/order.hpp"
#include "job/outputs.hpp"
#include "job/rank_report.hpp"
#include "job/rank_run.hpp"
#include "job/triangulated.hpp"

namespace driftmesh::app {
namespace {

using job::Request;
using job::timed;

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
  timed(notes, "write",
        [&] { write_distributed(ranks, piece, request.output.meshes, writing_of(request, holes, notes)); });
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

}  // namespace

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

}  // namespace driftmesh::app
