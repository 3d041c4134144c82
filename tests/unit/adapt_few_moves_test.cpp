#include <doctest/doctest.h>

#include <algorithm>
#include <random>
#include <utility>
#include <vector>

#include "adapt/few_moves.hpp"

using namespace driftmesh;
using adapt::few_moves;
using adapt::Loads;

namespace {

using Neighbors = std::vector<std::pair<SubdomainId, SubdomainId>>;
using Holders = IdVector<SubdomainId, Rank>;

/// Parts in a row.
struct Row {
  Loads loads;
  Holders holders;
  Neighbors neighbors;
};

Row row_of(const std::vector<double>& work, const std::vector<int>& holders, const std::vector<double>& speeds) {
  Row row;
  for (const double w : work) row.loads.work.push_back(w);
  for (const double speed : speeds) row.loads.speeds.push_back(speed);
  for (const int r : holders) row.holders.push_back(Rank{r});
  for (int i = 1; i < static_cast<int>(work.size()); ++i)
    row.neighbors.emplace_back(SubdomainId{i - 1}, SubdomainId{i});
  return row;
}

std::vector<int> moved_by(const Row& row, double even = 1.05) {
  std::vector<int> ranks;
  for (const Rank r : few_moves(row.loads, row.holders, row.neighbors, even)) ranks.push_back(static_cast<int>(r));
  return ranks;
}

}  // namespace

TEST_CASE("what is even stays") {
  CHECK(moved_by(row_of({10, 10, 10, 10}, {0, 0, 1, 1}, {0, 0})) == std::vector{0, 0, 1, 1});
}

TEST_CASE("the smallest part that suffices moves, or else the largest of the others, to a neighbor") {
  // rank 0 has 26 of 44, and may have 23.1; only its last part has a neighbor
  CHECK(moved_by(row_of({9, 4, 10, 3, 10, 8}, {0, 0, 0, 0, 1, 1}, {0, 0})) == std::vector{0, 0, 0, 1, 1, 1});
  Row star = row_of({8, 7, 15, 15}, {0, 0, 0, 1}, {0, 0});
  star.neighbors = {
      {SubdomainId{0}, SubdomainId{3}}, {SubdomainId{1}, SubdomainId{3}}, {SubdomainId{2}, SubdomainId{3}}};
  CHECK(moved_by(star) == std::vector{0, 1, 0, 1});
  star.loads = row_of({3, 4, 20, 15}, {0, 0, 0, 1}, {0, 0}).loads;
  CHECK(moved_by(star) == std::vector{1, 1, 0, 1});
  // rank 0 has 54.5 of 100 and may have 52.5: 1.2 and 0.9 are less than 5, which would suffice
  star = row_of({5, 1.2, 47.2, 0.9, 0.2, 45.5}, {0, 0, 0, 0, 0, 1}, {0, 0});
  for (const int part : {0, 1, 2, 3}) star.neighbors.emplace_back(SubdomainId{part}, SubdomainId{5});
  CHECK(moved_by(star) == std::vector{0, 1, 0, 1, 0, 1});
}

TEST_CASE("where no neighbor has room a rank is left, and others go on") {
  // ranks may have 20 each: 24 and 22 stay, and 22 gives the last part beside 12
  CHECK(moved_by(row_of({12, 12, 12, 10, 18, 4, 12}, {0, 0, 1, 1, 2, 2, 3}, {0, 0, 0, 0}), 1.0) ==
        std::vector{0, 0, 1, 1, 2, 3, 3});
}

TEST_CASE("where no part at the border fits another one goes") {
  // rank 0 has 34 of 60 and may have 31.5; its last part is too much for rank 1
  CHECK(moved_by(row_of({16, 3, 15, 26}, {0, 0, 0, 1}, {0, 0})) == std::vector{0, 1, 0, 1});
}

TEST_CASE("fast ranks get more, and ranks of unknown speed count as the mean") {
  CHECK(moved_by(row_of({10, 10, 10, 10, 10, 10}, {0, 0, 0, 1, 1, 1}, {1, 2})) == std::vector{0, 0, 1, 1, 1, 1});
  CHECK(moved_by(row_of({10, 10, 10, 10}, {0, 0, 0, 1}, {5, 0})) == std::vector{0, 0, 1, 1});
}

TEST_CASE("a plan is even, and moves little") {
  std::mt19937 random(7);
  int planned = 0;
  for (int round = 0; round < 200; ++round) {
    const int ranks = 2 + static_cast<int>(random() % 4), parts = 20 * ranks;
    std::vector<double> work;
    std::vector<int> holders;
    for (int i = 0; i < parts; ++i) {
      holders.push_back(i * ranks / parts);
      work.push_back(80 + static_cast<double>(random() % 41) + (i < parts / ranks ? 10 : 0));
    }
    const Row row = row_of(work, holders, std::vector<double>(static_cast<std::size_t>(ranks), 0.0));
    if (adapt::imbalance(row.loads, row.holders) <= 1.05) continue;
    const Holders next = few_moves(row.loads, row.holders, row.neighbors, 1.05);
    CHECK(adapt::imbalance(row.loads, next) <= adapt::imbalance(row.loads, row.holders));
    if (adapt::imbalance(row.loads, next) > 1.05) continue;
    ++planned;
    std::vector<double> of_rank(static_cast<std::size_t>(ranks), 0.0);
    double moved = 0, all = 0, allowed = 0;
    for (const SubdomainId s : ids_of(row.holders)) {
      const double w = row.loads.work[s];
      all += w;
      of_rank[to_index(row.holders[s])] += w;
      if (next[s] != row.holders[s]) moved += w;
    }
    for (const double w : of_rank)
      if (w > 1.05 * all / ranks) allowed += w - 1.05 * all / ranks + 130;  // and one part at most
    CHECK(moved <= allowed);
  }
  CHECK(planned > 20);
}
