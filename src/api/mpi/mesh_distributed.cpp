#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "api/call.hpp"
#include "api/library_request.hpp"
#include "balancer/policies/policy_factory.hpp"
#include "base/bytes.hpp"
#include "distributed/ghost_layer.hpp"
#include "distributed/write_distributed.hpp"
#include "driftmesh/error.hpp"
#include "driftmesh/ids.hpp"
#include "driftmesh/mpi/distributed.hpp"
#include "job/mpi/mpi_team.hpp"
#include "job/rank_run.hpp"

namespace driftmesh {
namespace {

/// What `work` returns; then closes `open`, a team or a channel of one, cleanly, even if the work fails on all ranks.
template <class Open, class Work>
auto then_close(Open& open, const Work& work) {
  try {
    auto result = work();
    open.close();
    return result;
  } catch (const std::exception&) {
    open.close();
    throw;
  }
}

/// Speaks of the library's options even when it ends the job.
class LibraryTeam final : public job::MpiTeam {
 public:
  explicit LibraryTeam(MPI_Comm communicator) : MpiTeam(MPI_Comm_c2f(communicator)) {}
  [[noreturn]] void abort(const std::string& message, int code) override {
    MpiTeam::abort(in_words_of_options(message), code);
  }
};

template <class Work>
auto with_team(MPI_Comm communicator, const Work& work) {
  LibraryTeam team(communicator);
  return then_close(team, [&] { return work(team); });
}

template <class Work>
auto with_channel(job::Team& team, const Work& work) {
  const std::unique_ptr<job::Channel> channel = team.open();
  return then_close(*channel, [&] {
    ExchangeRunner ranks(channel->transport());
    return work(ranks);
  });
}

/// Which of the callables that affect the mesh the caller gives on this rank.
Bytes callables_of(const MeshOptions& options) {
  ByteWriter writer;
  writer.value(static_cast<bool>(options.size));
  writer.value(static_cast<bool>(options.balance.own));
  return writer.take();
}

/// Ranks with different size functions would not agree on the points that they share.
void check_callables(const std::vector<Bytes>& of_ranks) {
  for (const Rank r : first_ids<Rank>(of_ranks.size()))
    if (of_ranks[to_index(r)] != of_ranks.front())
      throw Error("MeshOptions::size and MeshOptions::balance.own are for all ranks or for none, and ranks 0 and " +
                  to_string(r) + " differ; give the same on each rank");
}

job::Order order_for(const job::Team& team, Call& call) {
  call.check(job::kRanks);
  job::check_ranks(call.request(), job::kRanks, team.ranks());
  job::Domain domain = call.read_domain();
  const job::Triangulated triangulated =
      job::triangulate_domain(call.request(), domain, team.ranks(), job::Cut::kAlways, call.watch());
  return call.order(std::move(domain), triangulated, job::kRanks, team.ranks(), job::processes_of(team));
}

DistributedPiece mesh_on(job::Team& team, Call& call, const MeshOptions& options) {
  const std::vector<Bytes> callables = team.gather(callables_of(options));
  // Rephrase the error where it occurs: only its message travels to the other ranks.
  const auto make = [&] {
    return with_words_of_options([&] {
      check_callables(callables);
      return std::optional(order_for(team, call));
    });
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
    return with_channel(team, [&](ExchangeRunner& ranks) {
      write_distributed(ranks, piece, std::span(&path, 1));
      return true;
    });
  }));
}

}  // namespace driftmesh
