#pragma once

#include <mpi.h>

#include <exception>
#include <memory>
#include <vector>

#include "api/library_request.hpp"
#include "distributed/exchange.hpp"
#include "driftmesh/options.hpp"
#include "job/failure.hpp"
#include "job/mpi/mpi_team.hpp"
#include "job/request.hpp"
#include "job/same_on_ranks.hpp"
#include "job/team.hpp"

namespace driftmesh {

/// Throws Error for a communicator without a group of ranks that could work together: its use would end the process.
void require_usable(MPI_Comm communicator);

/// The options as this rank has them.
[[nodiscard]] std::vector<job::RankSetting> settings_of(const MeshOptions& options, const job::Request& request);

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

/// What `work` returns with the ranks of the communicator, unless one of them has `failed` before: then all throw that.
/// Errors are in the words of the library.
template <class Work>
auto with_team(MPI_Comm communicator, const Work& work, const std::exception_ptr& failed = nullptr) {
  return in_words_of_library([&] {
    require_usable(communicator);
    job::MpiTeam team(MPI_Comm_c2f(communicator), words_of_library);
    return then_close(team, [&] {
      job::agree_on_failure(team, failed);
      return work(team);
    });
  });
}

/// What `work` returns with the ranks of a team, by a channel of its own.
template <class Work>
auto with_channel(job::Team& team, const Work& work) {
  const std::unique_ptr<job::Channel> channel = team.open();
  return then_close(*channel, [&] {
    ExchangeRunner ranks(channel->transport());
    return work(ranks);
  });
}

}  // namespace driftmesh
