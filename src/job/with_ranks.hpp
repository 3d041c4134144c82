#pragma once

#include <exception>
#include <memory>

#include "distributed/ranks.hpp"
#include "job/team.hpp"

namespace driftmesh::job {

/// Does work of `ranks`, which are those of the team. What all of them throw together is thrown; what fails on one
/// alone ends the job, since the others wait for it.
template <class Work>
auto together(Team& team, const Ranks& ranks, const Work& work) {
  try {
    return work();
  } catch (const std::exception&) {
    if (!ranks.have_failed_together()) fail_alone(team);
    throw;
  }
}

/// The same with ranks that have a channel of their own: work(ranks).
template <class Work>
void with_ranks(Team& team, const Work& work) {
  const std::unique_ptr<Channel> channel = team.open();
  RanksOfTransport ranks(channel->transport());
  std::exception_ptr failure;
  try {
    together(team, ranks, [&] { work(ranks); });
  } catch (const std::exception&) {
    failure = std::current_exception();
  }
  channel->close();
  if (failure) std::rethrow_exception(failure);
}

}  // namespace driftmesh::job
