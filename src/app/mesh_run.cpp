#include "app/mesh_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <memory>
#include <thread>
#include <vector>

#include "app/mesh_outputs.hpp"
#include "app/run_notes.hpp"
#include "balancer/policies/policy_factory.hpp"
#include "base/staged_files.hpp"
#include "driftmesh/error.hpp"
#include "io/mesh_file.hpp"
#include "job/domain.hpp"
#include "job/files.hpp"
#include "job/here.hpp"
#include "job/make.hpp"
#include "job/mpi/mpi_team.hpp"
#include "job/on_ranks.hpp"
#include "job/rounds_on_ranks.hpp"
#include "job/same_on_ranks.hpp"
#include "job/with_ranks.hpp"
#include "picture/plot.hpp"

namespace driftmesh::app {
namespace {

using job::Request;

/// mpirun binds each rank to a core or a few, unless it is told otherwise.
void warn_of_few_cores(const Request& request, RunNotes& notes) {
  const auto cores = static_cast<std::int64_t>(std::thread::hardware_concurrency());
  if (cores == 0 || request.run.threads <= cores) return;
  notes.warn(fmt::format("a rank has {} threads, but may use only {} of the cores; start it with mpirun --bind-to none",
                         request.run.threads, cores));
}

job::Draw drawing(const Request& request) {
  if (request.output.picture.empty()) return nullptr;
  const std::string title = std::filesystem::path(job::input_name(request)).filename().string();
  return [&request, title](const Mesh& mesh) { plot_mesh(mesh, request.output.picture, {.title = title}); };
}

int mesh_at(job::Place& place, const Told& told, bool on_ranks, RunNotes& notes) {
  const Request& request = told.request;
  const job::Given given{.policies = balancer::make_policy};
  const job::Wanted wanted = job::wanted_of(request.output);
  const auto before = [&] {
    register_files(told, on_ranks ? place.ranks() : 1);
    if (on_ranks) warn_of_few_cores(request, notes);
  };
  const std::unique_ptr<job::Refined> made =
      job::make({request, job::kMesh, given, wanted, before}, place, notes.run, notes);
  job::timed(notes, "inspect", [&] { made->report(notes.run); });
  place.agree([&] {
    if (place.leads()) job::require_step(notes.run);
  });
  StagedFiles files;
  if (notes.run.complete || request.limits.keep_incomplete) {
    if (!request.output.session.empty()) made->save(request, notes);
    if (wanted.mesh) made->write(request.output, drawing(request), notes);
    notes.note_files(place.staged(files));
  }
  place.agree([&] {
    if (place.leads()) notes.finish();
  });
  place.commit(files);
  if (place.leads()) notes.show();
  if (notes.run.complete) return 0;
  std::cerr << "driftmesh: " << made->shortfall(request.limits.keep_incomplete).in(job::words_of(job::kMesh)) << '\n';
  return job::kStoppedByLimit;
}

int mesh_here(job::PlaceKind kind, const Told& told) {
  for (const std::string& output : told.request.output.meshes)
    if (is_for_ranks(output))
      throw InputError({output}, "has a file for each rank of MPI", "start the program with mpirun, or write a .mesh");
  job::Here here(kind, job::threads_of(told.request));
  RunNotes notes(told);
  return mesh_at(here, told, false, notes);
}

void mesh_in_rounds(job::Team& team, const Told& told, RunNotes& notes) {
  job::with_ranks(team, [&](Ranks& ranks) {
    job::RoundsOnRanks place(team, ranks, std::max(1, told.request.run.threads));
    ranks.alike([&] { static_cast<void>(mesh_at(place, told, true, notes)); });
  });
}

int mesh_on_ranks(const Told& told) {
  const protocol::MpiSession session;
  job::MpiTeam team(protocol::MpiSession::world(), job::words_of(job::kMesh));
  try {
    const std::string start = team.alone() ? "" : "mpirun -n " + std::to_string(team.ranks()) + " ";
    job::require_same(team, job::settings_of(told.request));
    RunNotes notes(told, start, !team.leads());
    if (told.request.run.method == job::Method::kRounds) {
      mesh_in_rounds(team, told, notes);
    } else {
      job::OnRanks place(team, balancer::make_policy);
      static_cast<void>(mesh_at(place, told, true, notes));
    }
  } catch (const std::exception&) {
    if (team.leads()) throw;
    return 0;  // all ranks have the error, and rank 0 reports it
  }
  team.close();
  return 0;
}

}  // namespace

int run_mesh(const Request& request, job::PlaceKind kind, const std::string& command, const std::string& config) {
  const Told told{request, command, config};
  return kind == job::kRanks ? mesh_on_ranks(told) : mesh_here(kind, told);
}

}  // namespace driftmesh::app
