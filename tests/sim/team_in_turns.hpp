#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "distributed/ranks.hpp"
#include "job/team.hpp"
#include "sim/turns.hpp"

namespace driftmesh::sim {

/// All messages under way between ranks that take turns.
class Post {
 public:
  explicit Post(Turns& turns) : turns_(turns) {}

  void send(int channel, Rank from, Rank to, Bytes bytes);
  [[nodiscard]] std::optional<protocol::Received> poll(int channel, Rank to);
  /// Returns when something may have arrived.
  void wait(int channel, Rank to);
  [[nodiscard]] Turns& turns() { return turns_; }

 private:
  struct Parcel {
    double arrives;
    protocol::Received content;
  };
  Turns& turns_;
  std::map<std::pair<int, Rank>, std::vector<Parcel>> boxes_;
};

/// A rank of a team whose ranks take turns.
class TeamInTurns final : public job::Team {
 public:
  /// `why`: where a rank says why it ends the job.
  TeamInTurns(Post& post, Rank rank, std::int32_t ranks, std::string& why);

  [[nodiscard]] Rank rank() const override { return rank_; }
  [[nodiscard]] std::int32_t ranks() const override { return ranks_; }
  [[nodiscard]] std::string host() const override { return host_of(rank_); }
  [[nodiscard]] int ranks_on_machine() const override { return 1; }
  [[nodiscard]] Bytes broadcast(Bytes bytes) override;
  [[nodiscard]] std::vector<Bytes> gather(const Bytes& bytes) override;
  [[nodiscard]] std::unique_ptr<job::Channel> open() override;
  [[noreturn]] void abort(const KeyText& message, int code) override;

  [[nodiscard]] static std::string host_of(Rank rank) { return "host" + to_string(rank); }

 private:
  Post& post_;
  Rank rank_;
  std::int32_t ranks_;
  std::string& why_;
  int channels_ = 0;
  std::unique_ptr<job::Channel> control_;
  RanksOfTransport all_;
};

}  // namespace driftmesh::sim
