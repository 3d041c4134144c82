#include <exception>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "api/call.hpp"
#include "api/library_request.hpp"
#include "api/mpi/fail_together.hpp"
#include "api/mpi/with_team.hpp"
#include "balancer/policies/policy_factory.hpp"
#include "base/key_error.hpp"
#include "distributed/ghost_layer.hpp"
#include "distributed/write_distributed.hpp"
#include "driftmesh/error.hpp"
#include "driftmesh/mpi/distributed.hpp"
#include "job/failure.hpp"
#include "job/mpi/mpi_team.hpp"
#include "job/on_ranks.hpp"
#include "job/same_on_ranks.hpp"

namespace driftmesh {

void require_usable(MPI_Comm communicator) {
  int began = 0, ended = 0, between_groups = 0;
  MPI_Initialized(&began);
  MPI_Finalized(&ended);
  if (began == 0 || ended != 0)
    throw Error(std::string("MPI ") + (began == 0 ? "has not been initialized" : "has been finalized") +
                "; call the functions for ranks between MPI_Init and MPI_Finalize");
  if (communicator == MPI_COMM_NULL)
    throw Error("the communicator is MPI_COMM_NULL; give one that this process belongs to");
  MPI_Comm_test_inter(communicator, &between_groups);
  if (between_groups != 0)
    throw Error(
        "the communicator is an intercommunicator, which joins two groups of ranks; give one of a single group, "
        "such as MPI_Intercomm_merge makes of it");
}

/// Of a callable, only whether there is one.
std::vector<job::RankSetting> settings_of(const MeshOptions& options, const job::Request& request) {
  std::vector<job::RankSetting> settings = job::settings_of(request);
  settings.push_back({KeyText::key("sizing.size"), options.size ? "a function" : "none"});
  settings.push_back({KeyText::key("balance.own"), options.balance.own ? "a policy" : "none"});
  return settings;
}

namespace {

DistributedPiece mesh_on(job::Team& team, Call& call, const MeshOptions& options) {
  job::require_same(team, settings_of(options, call.request()));
  job::OnRanks ranks(team, call.policies());
  job::RunRecord record;
  const std::unique_ptr<job::Refined> made = job::make(call.asked(job::kRanks), ranks, record, call.watch());
  call.require_step(ranks, *made, record);
  return made->take_piece(call.watch());
}

}  // namespace

DistributedPiece mesh_distributed(MPI_Comm communicator, const Pslg& input, const MeshOptions& options) {
  return in_words_of_library([&] {
    Call call(input, options, balancer::make_policy);
    return with_team(communicator, [&](job::Team& team) { return mesh_on(team, call, options); });
  });
}

GhostedPiece add_ghost_layer(MPI_Comm communicator, const DistributedPiece& piece) {
  return with_team(communicator, [&](job::Team& team) {
    return with_channel(team, [&](ExchangeRunner& ranks) {
      GhostLayer layer(piece);
      ranks.run(layer);
      return layer.take();
    });
  });
}

void write_distributed(MPI_Comm communicator, const DistributedPiece& piece, const std::string& path) {
  static_cast<void>(with_team(communicator, [&](job::Team& team) {
    job::require_same(team, {{"the path", path}});
    return with_channel(team, [&](ExchangeRunner& ranks) {
      write_distributed(ranks, piece, std::span(&path, 1));
      return true;
    });
  }));
}

void fail_together(MPI_Comm communicator, const std::exception_ptr& failure) {
  const auto join = [&](const std::exception_ptr& own) {
    static_cast<void>(with_team(
        communicator, [](job::Team&) { return true; }, own));
  };
  try {
    if (failure) std::rethrow_exception(failure);
  } catch (const KeyError& error) {  // the others may have a valid value: tell them whose it is
    return join(std::make_exception_ptr(Keyed<Error>(error.text())));
  } catch (...) {
    return join(failure);
  }
  join(nullptr);
}

}  // namespace driftmesh
