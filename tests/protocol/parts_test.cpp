#include <doctest/doctest.h>

#include <algorithm>
#include <map>
#include <random>
#include <set>

#include "driftmesh/error.hpp"
#include "protocol/aggregator.hpp"
#include "protocol/directory.hpp"
#include "protocol/split_set.hpp"

using namespace driftmesh;
using namespace driftmesh::protocol;

TEST_CASE("an aggregator sends a batch at its threshold and keeps what is below it") {
  Aggregator aggregator(0, 3);
  CHECK(!aggregator.add(1, 10, 0, {1, 1}));
  CHECK(!aggregator.add(2, 20, 0, {2, 1}));
  CHECK(!aggregator.add(1, 11, 0, {3, 1}));
  CHECK(aggregator.size() == 3);
  const auto full = aggregator.add(1, 10, 0, {1, 2});
  REQUIRE(full);
  CHECK(full->destination == 1);
  CHECK(full->message == Message(SplitBatch{{{10, 0, 0, 0, {{1, 1}, {1, 2}}}, {11, 0, 0, 0, {{3, 1}}}}}));
  CHECK(aggregator.size() == 1);
  const auto rest = aggregator.flush();
  REQUIRE(rest.size() == 1);
  CHECK(rest[0].destination == 2);
  CHECK(aggregator.empty());
  CHECK(aggregator.flush().empty());
}

TEST_CASE("an aggregator loses nothing, and keeps epochs apart") {
  Aggregator aggregator(3, 16);
  std::mt19937_64 random(11);
  std::multiset<std::tuple<Rank, SubdomainId, Epoch, EdgeId>> put, got;
  const auto collect = [&](const Outgoing& batch) {
    std::set<std::pair<SubdomainId, Epoch>> groups;
    for (const SplitGroup& group : std::get<SplitBatch>(batch.message).groups) {
      CHECK(group.origin == 3);
      CHECK(groups.emplace(group.to, group.epoch).second);
      for (const SplitEntry& entry : group.entries) got.emplace(batch.destination, group.to, group.epoch, entry.edge);
    }
  };
  for (EdgeId edge = 0; edge < 1000; ++edge) {
    const auto destination = static_cast<Rank>(random() % 5);
    const auto to = static_cast<SubdomainId>(random() % 6);
    const auto epoch = static_cast<Epoch>(random() % 2);
    put.emplace(destination, to, epoch, edge);
    if (const auto batch = aggregator.add(destination, to, epoch, {edge, 1})) collect(*batch);
    if (edge % 97 == 0)
      for (const Outgoing& batch : aggregator.flush()) collect(batch);
  }
  for (const Outgoing& batch : aggregator.flush()) collect(batch);
  CHECK(put == got);
  CHECK_THROWS_AS(Aggregator(0, 0), Error);
}

namespace {

dyadic::Path random_path(std::mt19937_64& random, int deepest) {
  const int depth = static_cast<int>(random() % static_cast<std::uint64_t>(deepest + 1));
  return (dyadic::Path{1} << depth) | (random() & ((dyadic::Path{1} << depth) - 1));
}

}  // namespace

TEST_CASE("a split set replays what is missing, ancestors first") {
  SplitSet set;
  CHECK(set.insert(0b1011) == std::vector<dyadic::Path>{0b1, 0b10, 0b101, 0b1011});
  CHECK(set.insert(0b1011).empty());
  CHECK(set.insert(0b10).empty());
  CHECK(set.insert(0b1010) == std::vector<dyadic::Path>{0b1010});
  CHECK(set.size() == 5);
}

TEST_CASE("split sets agree whatever the order and the repetitions") {
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    std::vector<dyadic::Path> splits(1 + random() % 40);
    for (auto& path : splits) path = random_path(random, seed % 5 == 0 ? dyadic::kMaxDepth : 6);

    // The truth by definition: every prefix of every path.
    std::set<dyadic::Path> truth;
    for (const auto path : splits)
      for (auto k = path; k != 0; k >>= 1) truth.insert(k);

    SplitSet one, other;
    std::vector<dyadic::Path> inserted;
    for (const auto path : splits)
      for (const auto fresh : one.insert(path)) {
        REQUIRE((fresh == 1 || std::count(inserted.begin(), inserted.end(), fresh >> 1) == 1));
        inserted.push_back(fresh);
      }
    auto again = splits;
    again.insert(again.end(), splits.begin(), splits.end());
    std::shuffle(again.begin(), again.end(), random);
    for (const auto path : again) other.insert(path);

    REQUIRE(std::vector<dyadic::Path>(truth.begin(), truth.end()) == one.paths());
    REQUIRE(one == other);
    REQUIRE(inserted.size() == truth.size());
    REQUIRE(digest(one) == digest(other));
    SplitSet more = one;
    if (!more.insert(random_path(random, dyadic::kMaxDepth)).empty()) REQUIRE(digest(more) != digest(one));
  }
}

// The truth about one subdomain that wanders: who owned it in each epoch. Every rank learns of some of it, in any
// order; the rules must bring a message from anywhere to where the subdomain is.
TEST_CASE("forwarding reaches the owner, epochs rise along the way, and hops are bounded") {
  int forwards = 0;
  for (std::uint64_t seed = 1; seed <= 500; ++seed) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const auto ranks = static_cast<Rank>(2 + random() % 6);
    const auto any_rank = [&] { return static_cast<Rank>(random() % static_cast<std::uint64_t>(ranks)); };
    std::vector<Directory> directories;
    std::vector<Rank> history{any_rank()};
    for (Rank r = 0; r < ranks; ++r) directories.emplace_back(r, history);
    for (auto moves = random() % 12; moves > 0; --moves) {
      const Rank from = history.back(), to = any_rank();
      if (to == from) continue;
      const Location next = directories[static_cast<std::size_t>(from)].depart(0, to);
      CHECK(next == Location{to, static_cast<Epoch>(history.size())});
      history.push_back(to);
      REQUIRE(directories[static_cast<std::size_t>(to)].arrive(0, next.epoch));
      CHECK(!directories[static_cast<std::size_t>(to)].arrive(0, next.epoch));
    }
    const auto last = static_cast<Epoch>(history.size() - 1);
    for (Rank sender = 0; sender < ranks; ++sender) {
      Location target = directories[static_cast<std::size_t>(sender)].where(0);
      const Epoch sent_with = target.epoch;
      Epoch hops = 0;
      for (;;) {
        const Directory& here = directories[static_cast<std::size_t>(target.owner)];
        const auto route = here.route(0, target.epoch);
        REQUIRE(route != Directory::Route::kHold);  // nothing is under way
        if (route == Directory::Route::kHere) break;
        REQUIRE(here.where(0).epoch > target.epoch);
        target = here.where(0);
        ++hops, ++forwards;
      }
      CHECK(target.owner == history.back());
      CHECK(hops <= last - sent_with);
    }
  }
  CHECK(forwards > 500);
}

TEST_CASE("a message that is ahead of its subdomain is held") {
  Directory directory(2, {0, 2});
  CHECK(directory.route(0, 0) == Directory::Route::kForward);  // a stray
  CHECK(directory.route(0, 1) == Directory::Route::kHold);     // somebody knows of a move to here that has not arrived
  directory.set(0, {2, 3});
  CHECK(directory.route(0, 1) == Directory::Route::kHold);
  CHECK(!directory.arrive(0, 2));  // epoch 3 is here already by the record
  CHECK(directory.arrive(0, 3));
  CHECK(directory.route(0, 1) == Directory::Route::kHere);
  CHECK(directory.depart(0, 1) == Location{1, 4});
  CHECK(directory.route(0, 3) == Directory::Route::kForward);
  CHECK(directory.route(0, 5) == Directory::Route::kHold);
  CHECK_THROWS_AS(directory.depart(0, 1), Error);
  CHECK(!directory.arrive(1, 0));
}
