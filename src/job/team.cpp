#include "job/team.hpp"

#include <cstdlib>
#include <new>

#include "base/failure.hpp"
#include "base/temporary_files.hpp"
#include "driftmesh/error.hpp"
#include "job/limits.hpp"
#include "protocol/lone_transport.hpp"

namespace driftmesh::job {
namespace {

class LoneChannel final : public Channel {
 public:
  [[nodiscard]] protocol::Transport& transport() override { return transport_; }
  [[nodiscard]] std::unique_ptr<balancer::Council> council(const RunPlan& /*plan*/) override { return nullptr; }
  void close() override {}

 private:
  protocol::LoneTransport transport_;
};

class LoneTeam final : public Team {
 public:
  [[nodiscard]] Rank rank() const override { return Rank{0}; }
  [[nodiscard]] std::int32_t ranks() const override { return 1; }
  [[nodiscard]] int ranks_on_machine() const override { return 1; }
  [[nodiscard]] Bytes broadcast(Bytes bytes) override { return bytes; }
  [[nodiscard]] std::vector<Bytes> gather(const Bytes& bytes) override { return {bytes}; }
  [[nodiscard]] std::unique_ptr<Channel> open() override { return std::make_unique<LoneChannel>(); }
  [[noreturn]] void abort(const std::string& message, int) override { throw Error(message); }
};

}  // namespace

std::unique_ptr<Team> lone_team() {
  return std::make_unique<LoneTeam>();
}

void fail_alone(Team& team) {
  if (team.alone()) throw;
  remove_noted_temporaries();  // nothing is destroyed
  const std::string who = "driftmesh: rank " + to_string(team.rank()) + ": ";
  try {
    throw;
  } catch (const LimitError& error) {
    team.abort(who + error.what(), kStoppedByLimit);
  } catch (const std::bad_alloc&) {
    team.abort(who + kOutOfMemory, kStoppedByLimit);
  } catch (const std::exception& error) {
    team.abort(who + error.what(), EXIT_FAILURE);
  }
  std::abort();  // not reached: nothing but exceptions of the standard library's kind is thrown here
}

}  // namespace driftmesh::job
