#include <memory>
#include <optional>
#include <span>
#include <utility>

#include "api/call.hpp"
#include "api/library_request.hpp"
#include "balancer/policies/policy_factory.hpp"
#include "distributed/write_distributed.hpp"
#include "driftmesh/mpi/distributed.hpp"
#include "job/mpi/mpi_team.hpp"
#include "job/rank_run.hpp"

namespace driftmesh {
namespace {

/// Does `work` with a team of the communicator's ranks, and closes it in good order, also where work fails on all
/// alike.
template <class Work>
auto with_team(MPI_Comm communicator, const Work& work) {
  job::MpiTeam team(MPI_Comm_c2f(communicator));
  try {
    auto result = work(team);
    team.close();
    return result;
  } catch (const std::exception&) {
    team.close();
    throw;
  }
}

/// The same with a channel of the team.
template <class Work>
auto with_channel(job::Team& team, const Work& work) {
  const std::unique_ptr<job::Channel> channel = team.open();
  try {
    ExchangeRunner ranks(channel->transport());
    auto result = work(ranks);
    channel->close();
    return result;
  } catch (const std::exception&) {
    channel->close();
    throw;
  }
}

DistributedPiece mesh_on(job::Team& team, Call& call) {
  // In the words of options already where the error is met: only what it says travels to the other ranks.
  const auto make = [&] {
    return with_words_of_options([&] { return std::optional(call.order_for(team, job::kRanks)); });
  };
  std::optional<job::Order> order = job::share(team, make, call.given().policies);
  job::RankRun run(team, std::move(*order), call.given().size, call.watch());
  run.refine();
  return with_channel(team, [&](ExchangeRunner& ranks) { return run.assemble(ranks); });
}

}  // namespace

DistributedPiece mesh_distributed(MPI_Comm communicator, const Pslg& input, const MeshOptions& options) {
  return with_words_of_options([&] {
    Call call(input, options, balancer::make_policy);
    return with_team(communicator, [&](job::Team& team) { return mesh_on(team, call); });
  });
}

void write_distributed(MPI_Comm communicator, const DistributedPiece& piece, const std::string& path) {
  static_cast<void>(with_team(communicator, [&](job::Team& team) {
    return with_channel(team, [&](ExchangeRunner& ranks) {
      write_distributed(ranks, piece, std::span(&path, 1));
      return true;
    });
  }));
}

}  // namespace driftmesh
