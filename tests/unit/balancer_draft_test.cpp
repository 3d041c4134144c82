// A plan that is being changed, compared with what follows from its moves alone.
#include <doctest/doctest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "balancer/planner/draft.hpp"
#include "balancer/planner/remap_parts.hpp"
#include "property/cases.hpp"
#include "protocol/packed_size.hpp"
#include "support/id_literals.hpp"
#include "support/load_snapshots.hpp"
#include "support/planned_moves.hpp"

using namespace driftmesh;
using namespace driftmesh::balancer;
using namespace driftmesh::testing;
using Index = Draft::Index;

namespace {

constexpr MoveCost kCost{.latency = 0.01, .bandwidth = 1e4, .pack_work = 0.003};

/// The owners that the moves make, by the numbers of the snapshot.
std::vector<Rank> owners_with(const LoadSnapshot& s, const std::vector<Move>& moves) {
  std::vector<Rank> owners;
  for (const SubdomainLoad& load : s.subdomains) {
    owners.push_back(load.owner);
    for (const Move& move : moves)
      if (move.subdomain == load.id) owners.back() = move.destination;
  }
  return owners;
}

/// Seconds of a rank with such owners: the work that it has, packing for what has left, and unpacking for what has
/// come.
double seconds_of(const LoadSnapshot& s, const std::vector<Rank>& owners, Rank r) {
  const double speed = assumed_speeds(s.ranks)[r];
  double seconds = s.ranks[r].remaining / speed;
  for (std::size_t i = 0; i < owners.size(); ++i) {
    const SubdomainLoad& load = s.subdomains[i];
    if (owners[i] == load.owner) continue;
    if (load.owner == r) seconds += kCost.for_giver(load.bytes, speed) - load.remaining / speed;
    if (owners[i] == r) seconds += kCost.for_taker(load.bytes, speed) + load.remaining / speed;
  }
  return seconds;
}

double border_of(const LoadSnapshot& s, const std::vector<Rank>& owners) {
  double twice = 0;
  for (std::size_t i = 0; i < owners.size(); ++i)
    for (const Neighbor& n : (*s.layout)[s.subdomains[i].id].neighbors)
      for (std::size_t j = 0; j < owners.size(); ++j)
        if (s.subdomains[j].id == n.subdomain && owners[i] != owners[j] &&
            is_open_border(s, s.subdomains[i], s.subdomains[j]))
          twice += n.length;
  return twice / 2;
}

double free_memory(const LoadSnapshot& s, const std::vector<Rank>& owners, Rank r) {
  double left = s.ranks[r].free_memory;
  for (std::size_t i = 0; i < owners.size(); ++i)
    if (owners[i] == r && s.subdomains[i].owner != r) left -= memory_for(s.subdomains[i]);
  return left;
}

void check_agrees(const Draft& draft, const LoadSnapshot& s, const std::vector<Rank>& owners) {
  std::vector<Move> moves;
  std::vector<double> borders;
  for (Index i = 0; i < draft.size(); ++i) {
    REQUIRE(draft.owner(i) == owners[i]);
    if (owners[i] != s.subdomains[i].owner) moves.push_back({s.subdomains[i].id, owners[i]});
    for (const Draft::Border& b : draft.borders(i)) borders.push_back(b.length);
  }
  REQUIRE(draft.list() == moves);
  REQUIRE(draft.moves() == moves.size());
  for (const Rank r : ids_of(s.ranks)) {
    REQUIRE(draft.times()[r] == doctest::Approx(seconds_of(s, owners, r)));
    std::vector<Index> held = draft.held_by(r), expected;
    for (Index i = 0; i < draft.size(); ++i)
      if (owners[i] == r && !s.subdomains[i].fixed) expected.push_back(i);
    std::ranges::sort(held);
    REQUIRE(held == expected);
  }
}

/// What the draft says of a change must follow from the owners before and after it.
void check_change(const Draft& draft, const LoadSnapshot& s, const std::vector<Rank>& owners, Index i, Rank to,
                  Index j) {
  std::vector<Rank> after = owners;
  after[i] = to;
  if (j != Draft::kNone) after[j] = owners[i];
  const Draft::Change change = draft.in_exchange(draft.change(i, to), j);
  REQUIRE(change.border == doctest::Approx(border_of(s, after) - border_of(s, owners)));
  const auto moved = [&](const std::vector<Rank>& who) {
    int moves = 0;
    for (std::size_t k = 0; k < who.size(); ++k) moves += who[k] != s.subdomains[k].owner;
    return moves;
  };
  REQUIRE(change.saved == moved(owners) - moved(after));
  const auto [here, there] = draft.times_after(i, to, j);
  REQUIRE(here == doctest::Approx(seconds_of(s, after, owners[i])));
  REQUIRE(there == doctest::Approx(seconds_of(s, after, to)));
  // Whoever comes home needs no memory; whoever comes from elsewhere fits once the other one has left.
  const auto fits = [&](Index k, Rank r) {
    return k == Draft::kNone || s.subdomains[k].owner == r || free_memory(s, after, r) >= 0;
  };
  REQUIRE(draft.has_memory(i, to, j) == (fits(i, to) && fits(j, owners[i])));
}

}  // namespace

TEST_CASE("a draft agrees with its moves, whatever is changed, and knows what a change would do") {
  auto random = seeded_generator("drafts");
  int exchanges = 0, without_memory = 0;
  for (std::int64_t n = 0; more_cases(n, 150, exchanges > 100 && without_memory > 100); ++n) {
    LoadSnapshot s = random_snapshot(random);
    if (s.subdomains.size() < 2 || s.ranks.size() < 2) continue;
    const auto any = [&](std::size_t count) { return random() % count; };
    for (SubdomainLoad& load : s.subdomains) {
      load.fixed = any(5) == 0;
      load.remaining = static_cast<double>(1 + any(4) * 100);
      load.bytes = any(30) * protocol::kBytesPerTriangle;
    }
    for (RankLoad& rank : s.ranks) rank.free_memory = any(3) == 0 ? kAmpleMemory : static_cast<double>(any(800));
    sum_up(s);
    std::vector<Move> moves{{s.subdomains[0].id, Rank{-1}}, {static_cast<SubdomainId>(9999), 0_rank}};
    for (const SubdomainLoad& load : s.subdomains)
      if (any(3) == 0) moves.push_back({load.id, static_cast<Rank>(any(s.ranks.size()))});
    Draft draft(s, moves, kCost);
    std::erase_if(moves, [&](const Move& m) {
      const SubdomainLoad* const load = find(s, m.subdomain);
      return load == nullptr || load->fixed || !s.ranks.has(m.destination);
    });
    std::vector<Rank> owners = owners_with(s, moves);
    check_agrees(draft, s, owners);
    for (int k = 0; k < 20; ++k) {
      const auto i = static_cast<Index>(any(owners.size()));
      auto j = static_cast<Index>(any(owners.size()));
      Rank to = static_cast<Rank>(any(s.ranks.size()));
      if (owners[i] != owners[j] && any(3) != 0)
        to = owners[j], ++exchanges;
      else
        j = Draft::kNone;
      if (to == owners[i] || s.subdomains[i].fixed || (j != Draft::kNone && s.subdomains[j].fixed)) continue;
      check_change(draft, s, owners, i, to, j);
      if (!draft.has_memory(i, to, j)) {
        ++without_memory;
        if (any(2) == 0) continue;
      }
      const std::uint64_t before = draft.changes();
      draft.make(draft.in_exchange(draft.change(i, to), j));
      REQUIRE(draft.changes() > before);
      REQUIRE(draft.last_change(to) > before);
      REQUIRE(draft.last_change(owners[i]) > before);
      if (j != Draft::kNone) owners[j] = owners[i];
      owners[i] = to;
      check_agrees(draft, s, owners);
    }
  }
  CHECK(exchanges > 100);
  CHECK(without_memory > 100);
}

TEST_CASE("the greatest shares decide who gets which part, and what is left goes where it is finished in time") {
  const auto remapped = [](const IdVector<Rank, double>& speeds, const std::vector<int>& owners,
                           const std::vector<int>& parts) {
    Layout layout = grid_layout(static_cast<int>(owners.size()), 1, static_cast<std::int32_t>(speeds.size()));
    for (std::size_t i = 0; i < owners.size(); ++i)
      layout.subdomains[SubdomainId(static_cast<int>(i))].owner = Rank{owners[i]};
    std::vector<Part> numbers;
    for (const int part : parts) numbers.push_back(Part{part});
    std::vector<int> found(speeds.size(), -1);
    const std::vector<Rank> ranks = remap_parts(initial_snapshot(layout, speeds), numbers, 0.02);
    for (std::size_t i = 0; i < parts.size(); ++i) {
      int& rank = found[static_cast<std::size_t>(parts[i])];
      CHECK((rank < 0 || rank == to_int(ranks[i])));
      rank = to_int(ranks[i]);
    }
    return found;
  };
  // Part 1 is too large for the slow rank that holds it; 2 and 3 are where the other one was made for.
  CHECK(remapped({100, 400, 400, 400}, {0, 0, 0, 0, 0, 0, 3, 3, 3, 3, 2, 2, 2, 2},
                 {1, 1, 1, 1, 0, 0, 2, 2, 2, 2, 3, 3, 3, 3}) == std::vector{0, 1, 3, 2});
  // One rank holds everything: it keeps a large part, and of the others the slow rank takes the small one.
  CHECK(remapped({100, 400, 400}, std::vector<int>(10, 2), {0, 0, 1, 1, 1, 1, 2, 2, 2, 2}) == std::vector{0, 2, 1});
}
