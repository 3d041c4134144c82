#include "job/ranks_progress.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <deque>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/key_error.hpp"
#include "driftmesh/error.hpp"

// What ranks say of one that has fallen silent, on a network and by a clock that the test turns.

using namespace driftmesh;

namespace {

struct Network {
  explicit Network(std::int32_t count) : ranks(count), mail(to_index(count)) {}
  std::int32_t ranks;
  std::vector<std::deque<protocol::Received>> mail;
  double now = 0;
};

class Line final : public job::Channel, public protocol::Transport {
 public:
  Line(Network& network, Rank rank) : network_(network), rank_(rank) {}
  [[nodiscard]] protocol::Transport& transport() override { return *this; }
  void close() override {}
  [[nodiscard]] Rank rank() const override { return rank_; }
  [[nodiscard]] std::int32_t ranks() const override { return network_.ranks; }
  void send(Rank to, Bytes bytes) override { network_.mail[to_index(to)].push_back({rank_, std::move(bytes)}); }
  std::optional<protocol::Received> poll() override {
    auto& mine = network_.mail[to_index(rank_)];
    if (mine.empty()) return std::nullopt;
    protocol::Received first = std::move(mine.front());
    mine.pop_front();
    return first;
  }
  void idle() override { network_.now += 1; }
  [[nodiscard]] double now() const override { return network_.now; }

 private:
  Network& network_;
  Rank rank_;
};

/// Ranks on hosts a, b, c, ...
class Hosts final : public job::Team {
 public:
  Hosts(Network& network, Rank rank) : network_(network), rank_(rank) {}
  [[nodiscard]] Rank rank() const override { return rank_; }
  [[nodiscard]] std::int32_t ranks() const override { return network_.ranks; }
  [[nodiscard]] std::string host() const override { return {static_cast<char>('a' + to_int(rank_))}; }
  [[nodiscard]] int ranks_on_machine() const override { return 1; }
  [[nodiscard]] Bytes broadcast(Bytes) override {
    ByteWriter all;
    for (std::int32_t k = 0; k < network_.ranks; ++k) all.text(Hosts(network_, Rank{k}).host());
    return all.take();
  }
  [[nodiscard]] std::vector<Bytes> gather(const Bytes&) override { return {}; }
  [[nodiscard]] std::unique_ptr<job::Channel> open() override { return std::make_unique<Line>(network_, rank_); }
  [[noreturn]] void abort(const KeyText& message, int) override { throw Keyed<Error>(message); }

 private:
  Network& network_;
  Rank rank_;
};

/// All ranks of a run, each with what it has said.
struct Run {
  Run(std::int32_t ranks, const job::Request::Patience& patience) : network(ranks) {
    for (std::int32_t k = 0; k < ranks; ++k) {
      Hosts team(network, Rank{k});
      all.push_back(std::make_unique<job::RanksProgress>(team, patience));
    }
  }

  /// All but the silent one take steps for so many seconds; what they say of others, with the rank that says it.
  std::map<std::int32_t, std::vector<std::string>> pass(double seconds, std::int32_t silent = -1) {
    std::map<std::int32_t, std::vector<std::string>> said;
    for (const double end = network.now + seconds; network.now < end; network.now += 0.25)
      for (std::int32_t k = 0; k < network.ranks; ++k) {
        if (k == silent) continue;
        static_cast<void>(all[to_index(k)]->tell(10 * k, "refining subdomain " + std::to_string(k)));
        if (std::string line = all[to_index(k)]->silence(); !line.empty()) said[k].push_back(std::move(line));
      }
    return said;
  }

  Network network;
  std::vector<std::unique_ptr<job::RanksProgress>> all;
};

}  // namespace

TEST_CASE("a rank that falls silent is named by the one after it, with its host and what it did, and when it answers") {
  for (const std::int32_t ranks : {2, 3, 5})
    for (std::int32_t silent = 0; silent < ranks; ++silent) {
      CAPTURE(ranks);
      CAPTURE(silent);
      Run run(ranks, {.silence = 10});
      CHECK(run.pass(60).empty());
      const auto said = run.pass(75, silent);
      const std::int32_t after = (silent + 1) % ranks;
      REQUIRE(said.size() == 1);
      REQUIRE(said.count(after) == 1);
      const std::vector<std::string>& lines = said.at(after);
      REQUIRE(lines.size() == 3);  // after 10, 20 and 40 s
      const std::string name = "rank " + std::to_string(silent) + " on " + static_cast<char>('a' + silent);
      CHECK(lines[0].starts_with(name + " has not answered for 10 s, refining subdomain " + std::to_string(silent) +
                                 " since "));
      CHECK(lines[2].starts_with(name + " has not answered for 4"));
      const auto again = run.pass(30);
      REQUIRE(again.size() <= 2);
      REQUIRE(again.count(after) == 1);
      CHECK(again.at(after) == std::vector<std::string>{name + " answers again"});
      CHECK(again.size() == 1);  // the one that was away accuses nobody
    }
}

TEST_CASE("patience that is limited ends the run, naming the rank and the key") {
  Run run(2, {.silence = 1, .give_up = 30});
  CHECK_NOTHROW(run.pass(60));
  CHECK_NOTHROW(run.pass(29, 1));
  try {
    run.pass(3, 1);
    FAIL("should have given up");
  } catch (const Error& error) {
    CHECK(std::string(error.what()).starts_with("rank 1 on b has not answered for 30 s"));
    CHECK(std::string(error.what()).find("run.give-up") != std::string::npos);
  }
}

TEST_CASE("a rank that is done is not missed, and rank 0 has the triangles of all") {
  Run run(3, {.silence = 2});
  run.pass(1);
  std::map<std::int32_t, std::vector<std::string>> said;
  bool first = true;
  run.all[1]->close(700, [&] {
    if (!std::exchange(first, false)) return;
    said = run.pass(20, 1);
    run.all[2]->close(9, [] {});
    run.all[0]->close(5, [] {});
  });
  CHECK(said.empty());
  CHECK(run.all[0]->triangles() == 714);
}

TEST_CASE("what a rank has sent before it was done may arrive after that") {
  Run run(3, {.silence = 2});
  run.pass(1);
  run.network.now += 1;
  static_cast<void>(run.all[1]->tell(7, "refining subdomain 1"));
  std::map<std::int32_t, std::vector<std::string>> said;
  bool first = true;
  run.all[1]->close(7, [&] {
    if (!std::exchange(first, false)) return;
    for (auto& mail : run.network.mail) std::reverse(mail.begin(), mail.end());
    said = run.pass(20, 1);
    run.all[2]->close(9, [] {});
    run.all[0]->close(5, [] {});
  });
  CHECK(said.empty());
}

TEST_CASE("a rank that does not listen tells what it is at, now and then, and accuses nobody") {
  Run run(2, {.silence = 10});
  run.pass(1);
  std::size_t told = 0;
  for (const double end = run.network.now + 30; run.network.now < end; run.network.now += 0.05) {
    const std::size_t before = run.network.mail[0].size();
    run.all[1]->tell_now(1, "writing a checkpoint");
    told += run.network.mail[0].size() - before;
    static_cast<void>(run.all[0]->tell(1, "waiting for other ranks"));
    CHECK(run.all[0]->silence().empty());
  }
  CHECK(told > 100);
  CHECK(told < 200);
  CHECK(run.all[1]->silence().empty());
  const auto said = run.pass(12, 1);
  REQUIRE(said.count(0) == 1);
  CHECK(said.at(0).front().find("writing a checkpoint since ") != std::string::npos);
}
