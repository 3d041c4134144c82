#include <doctest/doctest.h>
#include <mpi.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <random>
#include <vector>

#include "mpi/on_all_ranks.hpp"
#include "property/cases.hpp"
#include "support/random_subdomains.hpp"
#include "support/restless_rounds.hpp"

// Subdomains on real ranks, refined in rounds, that sleep, pause and move between ranks at random: each ends in the
// same state, to the last bit, as where nothing happens to it.

using namespace driftmesh;
using namespace driftmesh::mpi_test;
using namespace driftmesh::testing;

namespace {

std::int64_t sum_over_ranks(std::int64_t value) {
  MPI_Allreduce(MPI_IN_PLACE, &value, 1, MPI_INT64_T, MPI_SUM, MPI_COMM_WORLD);
  return value;
}

/// What all ranks say, on each of them.
std::vector<RestlessRounds::Told> exchanged(const std::vector<RestlessRounds::Told>& own) {
  const auto bytes = static_cast<int>(own.size() * sizeof(RestlessRounds::Told));
  std::vector<int> sizes(static_cast<std::size_t>(rank_count())), begins;
  MPI_Allgather(&bytes, 1, MPI_INT, sizes.data(), 1, MPI_INT, MPI_COMM_WORLD);
  int total = 0;
  for (const int size : sizes) {
    begins.push_back(total);
    total += size;
  }
  std::vector<RestlessRounds::Told> all(static_cast<std::size_t>(total) / sizeof(RestlessRounds::Told));
  MPI_Allgatherv(own.data(), bytes, MPI_BYTE, all.data(), sizes.data(), begins.data(), MPI_BYTE, MPI_COMM_WORLD);
  return all;
}

/// The rounds of this rank, with moves that all ranks draw alike.
class RanksInRounds {
 public:
  RanksInRounds(const RandomSubdomains& world, const SubdomainContext& context, std::uint64_t seed)
      : rounds_(context, seed * 1000 + static_cast<std::uint64_t>(own_rank()) + 1), random_(seed) {
    for (const SubdomainId k : first_ids<SubdomainId>(world.size())) {
      owners_.push_back(random_rank());
      if (owners_[k] == own_rank()) rounds_.add(k);
    }
  }

  void run() {
    for (;;) {
      const std::vector<RestlessRounds::Told> told = exchanged(rounds_.refine());
      if (told.empty()) return;
      for (const SubdomainId k : ids_of(owners_))
        if (random_() % 3 == 0) move(k, random_rank());
      rounds_.tell(told);
      for (const SubdomainId k : ids_of(owners_))
        if (random_() % 3 == 0) move(k, random_rank());
    }
  }

  [[nodiscard]] RestlessRounds& rounds() { return rounds_; }
  [[nodiscard]] int moves() const { return moves_; }

 private:
  [[nodiscard]] int random_rank() { return static_cast<int>(random_() % static_cast<std::uint64_t>(rank_count())); }

  void move(SubdomainId k, int to) {
    const int from = std::exchange(owners_[k], to);
    if (from == to) return;
    ++moves_;
    if (from == own_rank()) {
      const Bytes packed = rounds_.remove(k);
      MPI_Send(packed.data(), static_cast<int>(packed.size()), MPI_BYTE, to, to_int(k), MPI_COMM_WORLD);
    }
    if (to == own_rank()) {
      MPI_Status status;
      int size = 0;
      MPI_Probe(from, to_int(k), MPI_COMM_WORLD, &status);
      MPI_Get_count(&status, MPI_BYTE, &size);
      Bytes packed(static_cast<std::size_t>(size));
      MPI_Recv(packed.data(), size, MPI_BYTE, from, to_int(k), MPI_COMM_WORLD, MPI_STATUS_IGNORE);
      rounds_.add(packed);
    }
  }

  RestlessRounds rounds_;
  std::mt19937_64 random_;  // the same on all ranks
  IdVector<SubdomainId, int> owners_;
  int moves_ = 0;
};

}  // namespace

TEST_CASE("sleep, pauses and moves between ranks change no bit of what is refined afterwards") {
  auto seeds = seeded_generator("rounds on ranks");
  Unrest all;
  std::int64_t moves = 0;
  bool seen_all = false;
  for (std::int64_t i = 0; more_cases(i, 12, seen_all); ++i) {
    const std::uint64_t seed = seeds() % 100'000;
    CAPTURE(seed);
    const RandomSubdomains world(seed, static_cast<int>(4 + seed % 9), 1500);
    SubdomainContext context = world.context();
    context.presplit = false;
    context.bounds.min_angle = 30;
    RestlessRounds quiet(context, 0);
    for (const SubdomainId k : first_ids<SubdomainId>(world.size())) quiet.add(k);
    quiet.run();
    const std::map<SubdomainId, Bytes> expected = quiet.states();
    RanksInRounds ranks(world, context, seed);
    ranks.run();
    const std::map<SubdomainId, Bytes> states = ranks.rounds().states();
    for (const auto& [id, state] : states) CHECK(state == expected.at(id));
    CHECK(sum_over_ranks(static_cast<std::int64_t>(states.size())) == static_cast<std::int64_t>(expected.size()));
    moves += ranks.moves();
    all.slept += sum_over_ranks(ranks.rounds().unrest().slept);
    all.woken += sum_over_ranks(ranks.rounds().unrest().woken);
    all.told_after_waking += sum_over_ranks(ranks.rounds().unrest().told_after_waking);
    seen_all = all.slept > 10 && all.woken > 10 && all.told_after_waking > 0 && (moves > 10 || rank_count() == 1);
  }
  CHECK(seen_all);
}
