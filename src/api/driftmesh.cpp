#include "api/driftmesh.hpp"

#include <optional>
#include <span>
#include <utility>

#include "distributed/write_distributed.hpp"
#include "driftmesh/error.hpp"
#include "job/check.hpp"
#include "job/keys.hpp"
#include "job/mpi/mpi_team.hpp"
#include "job/order.hpp"
#include "job/prepare.hpp"
#include "job/rank_run.hpp"

namespace driftmesh {
namespace {

job::Request request_of(const DistributedOptions& options) {
  job::Request request;
  request.bounds.angle = options.min_angle;
  request.bounds.area = options.max_area;
  request.bounds.region_areas = options.region_areas;
  request.decomposition.subdomains = options.subdomains;
  request.balance.policy = options.balance;
  for (const auto& [key, text] : {std::pair("mapping.method", options.mapping), {"run.presplit", options.presplit}})
    job::store(request, job::find_key(key), job::read_value(*job::find_key(key).key, text));
  return request;
}

/// What rank 0 makes of its input and its options.
job::Order prepare_order(const job::Given& given, const DistributedOptions& options, const job::Team& team) {
  const job::Request request = request_of(options);
  job::check(request, job::kRanks);
  job::Watch watch;
  job::Domain domain = job::read_domain(request, given, watch);
  const IdVector<Rank, double> speeds(to_index(team.ranks()), 1.0);
  job::Prepared prepared = job::prepare(request, domain, given, job::kRanks, speeds, job::Limits{}, watch);
  return {std::move(prepared.plan), std::move(domain.pslg), request.sizing, request.limits, {}, false};
}

DistributedPiece mesh_on(job::Team& team, const job::Given& given, const DistributedOptions& options) {
  std::optional<job::Order> order =
      job::share(team, [&] { return std::optional(prepare_order(given, options, team)); });
  job::Watch watch;
  job::RankRun run(team, std::move(*order), given.size, watch);
  run.refine();
  const auto channel = team.open();
  ExchangeRunner ranks(channel->transport());
  DistributedPiece piece = run.assemble(ranks);
  channel->close();
  return piece;
}

/// Does `work` with a team of the communicator's ranks, and closes it in good order, also where work fails on all
/// alike.
template <class Work>
auto with_team(int communicator, const Work& work) {
  job::MpiTeam team(communicator);
  try {
    auto result = work(team);
    team.close();
    return result;
  } catch (const std::exception&) {
    team.close();
    throw;
  }
}

}  // namespace

DistributedPiece mesh_distributed(int communicator, const Pslg& input, const DistributedOptions& options) {
  return with_team(communicator, [&](job::Team& team) {
    return mesh_on(team, {.input = &input, .size = options.size, .decomposition = nullptr, .policy = nullptr}, options);
  });
}

DistributedPiece mesh_distributed(int communicator, const Pslg& input, const Decomposition& decomposition,
                                  const DistributedOptions& options) {
  return with_team(communicator, [&](job::Team& team) {
    return mesh_on(team, {.input = &input, .size = options.size, .decomposition = &decomposition, .policy = nullptr},
                   options);
  });
}

void write_distributed(int communicator, const DistributedPiece& piece, const std::string& path) {
  static_cast<void>(with_team(communicator, [&](job::Team& team) {
    const auto channel = team.open();
    try {
      ExchangeRunner ranks(channel->transport());
      write_distributed(ranks, piece, std::span(&path, 1));
    } catch (const std::exception&) {
      channel->close();
      throw;
    }
    channel->close();
    return 0;
  }));
}

}  // namespace driftmesh
