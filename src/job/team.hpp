#pragma once

#include <exception>
#include <memory>
#include <string>
#include <vector>

#include "base/bytes.hpp"
#include "base/key_text.hpp"
#include "driftmesh/ids.hpp"
#include "protocol/transport.hpp"

namespace driftmesh::job {

/// The communication channel of refinement: its messages cannot mix with others.
class Channel {
 public:
  virtual ~Channel() = default;
  Channel(const Channel&) = delete;
  Channel& operator=(const Channel&) = delete;

  [[nodiscard]] virtual protocol::Transport& transport() = 0;
  /// Closes the channel cleanly: everything sent has been received. Collective. Without it, messages under way may be
  /// lost.
  virtual void close() = 0;

 protected:
  Channel() = default;
};

/// The ranks that make a mesh together: those of a communicator (mpi/mpi_team.hpp). All ranks must make collective
/// calls in the same order.
class Team {
 public:
  virtual ~Team() = default;
  Team(const Team&) = delete;
  Team& operator=(const Team&) = delete;

  [[nodiscard]] virtual Rank rank() const = 0;
  [[nodiscard]] virtual std::int32_t ranks() const = 0;
  [[nodiscard]] bool leads() const { return rank() == Rank{0}; }
  [[nodiscard]] bool alone() const { return ranks() == 1; }
  /// What this rank's machine is called.
  [[nodiscard]] virtual std::string host() const = 0;
  /// The number of ranks that share this machine's memory.
  [[nodiscard]] virtual int ranks_on_machine() const = 0;

  /// The `bytes` of rank 0, on every rank. Collective.
  [[nodiscard]] virtual Bytes broadcast(Bytes bytes) = 0;
  /// The bytes of every rank on rank 0; empty elsewhere. Collective. For reports, not for meshes.
  [[nodiscard]] virtual std::vector<Bytes> gather(const Bytes& bytes) = 0;
  /// A barrier.
  void meet() {
    static_cast<void>(gather({}));
    static_cast<void>(broadcast({}));
  }
  /// Opens a channel. Collective.
  [[nodiscard]] virtual std::unique_ptr<Channel> open() = 0;

  /// Prints `message` and ends the whole job: the others would wait forever for a rank that failed on its own.
  [[noreturn]] virtual void abort(const KeyText& message, int code) = 0;

 protected:
  Team() = default;
};

/// Called while handling an exception that occurred on one rank only: rethrows it if the rank is alone, and otherwise
/// ends the job with its message.
[[noreturn]] void fail_alone(Team& team);

/// Does work that can fail on one rank only, with fail_alone.
template <class Work>
auto by_itself(Team& team, const Work& work) {
  try {
    return work();
  } catch (const std::exception&) {
    fail_alone(team);
  }
}

}  // namespace driftmesh::job
