#include <doctest/doctest.h>

#include <algorithm>
#include <map>
#include <random>
#include <set>

#include "driftmesh/error.hpp"
#include "protocol/aggregator.hpp"
#include "protocol/directory.hpp"
#include "protocol/split_set.hpp"
#include "support/id_literals.hpp"

using namespace driftmesh;
using namespace driftmesh::protocol;

TEST_CASE("an aggregator sends a batch at its threshold and keeps smaller ones") {
  Aggregator aggregator(0_rank, 3);
  CHECK(!aggregator.add(1_rank, 10_sub, 0, {1_root, 1}));
  CHECK(!aggregator.add(2_rank, 20_sub, 0, {2_root, 1}));
  CHECK(!aggregator.add(1_rank, 11_sub, 0, {3_root, 1}));
  CHECK(aggregator.size() == 3);
  const auto full = aggregator.add(1_rank, 10_sub, 0, {1_root, 2});
  REQUIRE(full);
  CHECK(full->destination == 1_rank);
  CHECK(full->message == Message(SplitBatch{{{10_sub, 0, 0_rank, 0, {{1_root, 1}, {1_root, 2}}},
                                             {11_sub, 0, 0_rank, 0, {{3_root, 1}}}}}));
  CHECK(aggregator.size() == 1);
  const auto rest = aggregator.flush();
  REQUIRE(rest.size() == 1);
  CHECK(rest[0].destination == 2_rank);
  CHECK(aggregator.empty());
  CHECK(aggregator.flush().empty());
}

TEST_CASE("an aggregator loses nothing, and keeps epochs apart") {
  Aggregator aggregator(3_rank, 16);
  std::mt19937_64 random(11);
  std::multiset<std::tuple<Rank, SubdomainId, Epoch, GlobalRootId>> put, got;
  const auto collect = [&](const Outgoing& batch) {
    std::set<std::pair<SubdomainId, Epoch>> groups;
    for (const SplitGroup& group : std::get<SplitBatch>(batch.message).groups) {
      CHECK(group.origin == 3_rank);
      CHECK(groups.emplace(group.to, group.epoch).second);
      for (const SplitPoint<GlobalRootId>& split : group.points)
        got.emplace(batch.destination, group.to, group.epoch, split.root);
    }
  };
  for (const GlobalRootId root : first_ids<GlobalRootId>(1000)) {
    const auto destination = static_cast<Rank>(random() % 5);
    const auto to = static_cast<SubdomainId>(random() % 6);
    const auto epoch = static_cast<Epoch>(random() % 2);
    put.emplace(destination, to, epoch, root);
    if (const auto batch = aggregator.add(destination, to, epoch, {root, 1})) collect(*batch);
    if (to_int(root) % 97 == 0)
      for (const Outgoing& batch : aggregator.flush()) collect(batch);
  }
  for (const Outgoing& batch : aggregator.flush()) collect(batch);
  CHECK(put == got);
  CHECK_THROWS_AS(Aggregator(0_rank, 0), Error);
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

    // The reference by definition: every prefix of every path.
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

TEST_CASE("each part of a digest counts every path, in any order") {
  std::mt19937_64 random(5);
  std::set<std::uint64_t> sums, toggles;
  for (const int size : {0, 1, 2, 7, 40}) {
    CAPTURE(size);
    std::vector<SplitDigest> each;
    SplitDigest whole;
    for (int k = 0; k < size; ++k) {
      const dyadic::Path path = random_path(random, dyadic::kMaxDepth);
      whole.add(path);
      each.emplace_back().add(path);
      CHECK(each.back().count == 1);
      CHECK(each.back().sum == each.back().toggle);  // the hash of the only path
    }
    SplitDigest expected{static_cast<std::uint64_t>(size), 0, 0};
    for (const SplitDigest& one : each) expected.sum += one.sum, expected.toggle ^= one.toggle;
    CHECK(whole == expected);
    sums.insert(whole.sum);
    toggles.insert(whole.toggle);
  }
  CHECK(sums.size() == 5);
  CHECK(toggles.size() == 5);
}

// The history of a moving subdomain: its owner in each epoch. Every rank learns part of it, in any order; the rules
// must deliver a message from anywhere to the subdomain's current rank.
TEST_CASE("forwarding reaches the owner, epochs rise along the way, and hops are bounded") {
  int forwards = 0;
  for (std::uint64_t seed = 1; seed <= 500; ++seed) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const auto ranks = static_cast<std::int32_t>(2 + random() % 6);
    const auto any_rank = [&] { return static_cast<Rank>(random() % static_cast<std::uint64_t>(ranks)); };
    IdVector<Rank, Directory> directories;
    std::vector<Rank> history{any_rank()};
    const IdVector<SubdomainId, Rank> owners(history);
    for (const Rank r : first_ids<Rank>(ranks)) directories.emplace_back(r, owners);
    for (auto moves = random() % 12; moves > 0; --moves) {
      const Rank from = history.back(), to = any_rank();
      if (to == from) continue;
      const Location next = directories[from].depart(0_sub, to);
      CHECK(next == Location{to, static_cast<Epoch>(history.size())});
      history.push_back(to);
      REQUIRE(directories[to].arrive(0_sub, next.epoch));
      CHECK(!directories[to].arrive(0_sub, next.epoch));
    }
    const auto last = static_cast<Epoch>(history.size() - 1);
    for (const Rank sender : first_ids<Rank>(ranks)) {
      Location target = directories[sender].where(0_sub);
      const Epoch sent_with = target.epoch;
      Epoch hops = 0;
      for (;;) {
        const Directory& here = directories[target.owner];
        const auto route = here.route(0_sub, target.epoch);
        REQUIRE(route != Directory::Route::kHold);  // nothing is under way
        if (route == Directory::Route::kHere) break;
        REQUIRE(here.where(0_sub).epoch > target.epoch);
        target = here.where(0_sub);
        ++hops, ++forwards;
      }
      CHECK(target.owner == history.back());
      CHECK(hops <= last - sent_with);
    }
  }
  CHECK(forwards > 500);
}

TEST_CASE("a message that arrives before its subdomain is held") {
  const IdVector<SubdomainId, Rank> owners{0_rank, 2_rank};
  Directory directory(2_rank, owners);
  CHECK(directory.route(0_sub, 0) == Directory::Route::kForward);  // a stray
  CHECK(directory.route(0_sub, 1) ==
        Directory::Route::kHold);  // some rank knows of a move to here that has not arrived
  directory.set(0_sub, {2_rank, 3});
  CHECK(directory.route(0_sub, 1) == Directory::Route::kHold);
  CHECK(!directory.arrive(0_sub, 2));  // epoch 3 is here already by the record
  CHECK(directory.arrive(0_sub, 3));
  CHECK(directory.route(0_sub, 1) == Directory::Route::kHere);
  CHECK(directory.depart(0_sub, 1_rank) == Location{1_rank, 4});
  CHECK(directory.route(0_sub, 3) == Directory::Route::kForward);
  CHECK(directory.route(0_sub, 5) == Directory::Route::kHold);
  CHECK_THROWS_AS(directory.depart(0_sub, 1_rank), Error);
  CHECK(!directory.arrive(1_sub, 0));
}
