#pragma once

#include <memory>
#include <vector>

#include "distributed/exchange.hpp"
#include "driftmesh/distributed_piece.hpp"
#include "job/place.hpp"
#include "job/request.hpp"
#include "job/team.hpp"
#include "job/watch.hpp"

namespace driftmesh::job {

/// Does work(runner) with a channel of its own. A failure on one rank ends the job.
template <class Work>
void exchange_on(Team& team, const Work& work) {
  const std::unique_ptr<Channel> channel = team.open();
  by_itself(team, [&] {
    ExchangeRunner ranks(channel->transport());
    work(ranks);
  });
  channel->close();
}

/// Writes the pieces of all ranks, and has rank 0 draw the whole mesh if `draw` is given. `holes`: of the domain.
/// Collective. A failure on one rank ends the job.
void write_on_ranks(Team& team, const DistributedPiece& piece, const Request::Output& files,
                    const std::vector<Point>& holes, const Draw& draw, Watch& watch);

}  // namespace driftmesh::job
