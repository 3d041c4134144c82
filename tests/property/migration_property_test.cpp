#include <doctest/doctest.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <functional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "driftmesh/generate.hpp"
#include "mesh/digest.hpp"
#include "mesh/exceptions.hpp"
#include "mesh/refiner.hpp"
#include "mesh/renumber.hpp"
#include "mesh/triangulation_fault.hpp"
#include "migration/dormant_mesh.hpp"
#include "migration/packed_form.hpp"
#include "property/cases.hpp"
#include "protocol/packed_size.hpp"
#include "support/random_subdomains.hpp"
#include "support/restless_rounds.hpp"

// Subdomains that are packed and unpacked at random moments, compared with twins that stay in place: both must reach
// the same mesh, by the same steps, with the same bytes at every moment.

using namespace driftmesh;
using namespace driftmesh::testing;

namespace {

using Move = std::function<Subdomain(const Subdomain&, const SubdomainContext&)>;

Subdomain move_honestly(const Subdomain& subdomain, const SubdomainContext& context) {
  return Subdomain::unpack(subdomain.pack(), context);
}

/// Simulates a packed form that omits pending points.
Subdomain move_without_pending(const Subdomain& subdomain, const SubdomainContext& context) {
  SubdomainState state = unpack(subdomain.pack());
  state.pending.clear();
  SubdomainView view{state.id, state.refined, state.pending, {}, nullptr};
  if (state.body) view.body.emplace(SubdomainView::Body{state.body->part, state.body->refiner, state.body->forecast});
  return Subdomain::unpack(pack(view), context);
}

struct Outcome {
  std::string difference;  ///< the first between the twins, in words
  int moves = 0;
  std::multiset<RefinerState::Stage> stages;  ///< at the moves
  int before_start = 0, with_pending = 0, after_end = 0;

  /// Whether moves occurred in all stages.
  [[nodiscard]] bool saw_all() const {
    for (const auto stage : {RefinerState::Stage::kSegments, RefinerState::Stage::kFine, RefinerState::Stage::kRest,
                             RefinerState::Stage::kDone})
      if (!stages.contains(stage)) return false;
    return before_start > 0 && with_pending > 10 && after_end > 10;
  }
};

void note_moment(const Subdomain& subdomain, Outcome& outcome) {
  ++outcome.moves;
  const SubdomainState state = unpack(subdomain.pack());
  if (state.body)
    outcome.stages.insert(state.body->refiner.stage);
  else
    ++outcome.before_start;
  outcome.with_pending += !state.pending.empty();
  outcome.after_end += !subdomain.active();
}

bool same_counters(const Subdomain& a, const Subdomain& b) {
  const RefineCounters &c = a.counters(), &d = b.counters();
  return c.free_points == d.free_points && c.segment_points == d.segment_points &&
         c.deleted_points == d.deleted_points && c.encroaching == d.encroaching && c.given_up == d.given_up;
}

/// The whole refinement of one subdomain and its twin, in slices, with external split points.
Outcome live_and_move(RandomSubdomains& world, SubdomainId id, const Move& move) {
  Outcome outcome;
  Subdomain stays(id, world.context()), moves(id, world.context());
  std::vector<SplitPoint<GlobalRootId>> said_by_one, said_by_other;
  auto& random = world.random();
  for (int quiet = 0; quiet < 3;) {
    for (auto points = random() % 3; points > 1 && quiet == 0; --points) {
      const SplitPoint<GlobalRootId> split = world.split_of(id, 5);
      stays.tell(split);
      moves.tell(split);
    }
    for (auto times = random() % 4; times > 1; --times) {
      note_moment(moves, outcome);
      moves = move(moves, world.context());
    }
    if (stays.active()) {
      // Every step packs the whole mesh: where narrow places take hundreds of times as many triangles, steps are
      // larger.
      const auto slice = static_cast<std::int64_t>(1 + random() % (random() % 4 == 0 ? 200 : 8)) +
                         (stays.triangles() > 4000 ? stays.triangles() / 20 : 0);
      stays.work(slice, said_by_one);
      if (!moves.active()) outcome.difference = "only one is active";
      moves.work(slice, said_by_other);
    }
    if (stays.pack() != moves.pack()) outcome.difference = "packed forms";
    if (said_by_one != said_by_other) outcome.difference = "points said";
    if (!outcome.difference.empty()) return outcome;
    if (!stays.active()) ++quiet;  // split points wake it once or twice
    if (quiet == 1 && random() % 2 == 0) {
      const SplitPoint<GlobalRootId> split = world.split_of(id, 7);
      stays.tell(split);
      moves.tell(split);
    }
  }
  if (mesh_digest(stays.mesh().mesh) != mesh_digest(moves.mesh().mesh)) outcome.difference = "digests";
  if (!same_counters(stays, moves)) outcome.difference = "counters";
  return outcome;
}

}  // namespace

TEST_CASE("a subdomain that moves at any moment, any number of times, ends like one that stays") {
  auto seeds = seeded_generator("moving subdomains");
  Outcome all;
  for (std::int64_t i = 0; more_cases(i, 150, all.saw_all()); ++i) {
    const std::uint64_t seed = seeds() % 100'000;
    CAPTURE(seed);
    RandomSubdomains world(seed, static_cast<int>(1 + seed % 6), 600);
    const auto id = static_cast<SubdomainId>(world.random()() % static_cast<std::uint64_t>(world.size()));
    const Outcome outcome = live_and_move(world, id, move_honestly);
    CHECK(outcome.difference == "");
    all.moves += outcome.moves;
    all.stages.insert(outcome.stages.begin(), outcome.stages.end());
    all.before_start += outcome.before_start;
    all.with_pending += outcome.with_pending;
    all.after_end += outcome.after_end;
  }
  MESSAGE(all.moves << " moves: " << all.before_start << " before the start, " << all.with_pending
                    << " with points to take in, " << all.after_end << " after the end");
  CHECK(all.saw_all());
}

TEST_CASE("a packed form without the pending points is detected") {
  int found = 0, lives = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed, ++lives) {
    RandomSubdomains world(seed, 3, 300);
    found += !live_and_move(world, SubdomainId{0}, move_without_pending).difference.empty();
  }
  CHECK(found > lives / 2);
}

TEST_CASE("a subdomain that sleeps whenever it can finishes, and has all points that were sent to it") {
  auto seeds = seeded_generator("sleeping subdomains");
  int slept = 0, woken = 0, slept_through = 0, moved = 0;
  for (std::int64_t i = case_count(60); i > 0; --i) {
    const std::uint64_t seed = seeds() % 100'000;
    CAPTURE(seed);
    RandomSubdomains world(seed, 3, 500);
    auto& random = world.random();
    const auto id = static_cast<SubdomainId>(random() % static_cast<std::uint64_t>(world.size()));
    Subdomain subdomain(id, world.context());
    std::vector<SplitPoint<GlobalRootId>> said, told;
    for (int round = 0; round < 12; ++round) {
      while (subdomain.active()) subdomain.work(1000, said);
      const std::uint64_t digest = mesh_digest(subdomain.mesh().mesh);
      const std::int64_t triangles = subdomain.triangles();
      subdomain.sleep();
      REQUIRE(subdomain.dormant());
      REQUIRE(subdomain.triangles() == triangles);
      ++slept;
      if (random() % 3 == 0) {
        const Bytes packed = subdomain.pack();
        subdomain = Subdomain::unpack(packed, world.context(), random() % 2 == 0 ? Source::kThisRun : Source::kUnknown);
        REQUIRE(subdomain.dormant());
        REQUIRE(subdomain.pack() == packed);
        ++moved;
      }
      if (random() % 2 == 0) {
        subdomain.wake();
        REQUIRE(mesh_digest(subdomain.mesh().mesh) == digest);
        subdomain.sleep();
      }
      told.push_back(!told.empty() && random() % 2 == 0 ? told[random() % told.size()] : world.split_of(id, 6));
      subdomain.tell(told.back());
      ++(subdomain.active() ? woken : slept_through);
      if (!subdomain.active()) subdomain.wake();
    }
    while (subdomain.active()) subdomain.work(1000, said);
    const SubdomainMesh& part = subdomain.mesh();
    for (const SplitPoint<GlobalRootId>& split : told) {
      const auto root = static_cast<RootId>(std::ranges::lower_bound(part.roots, split.root) - part.roots.begin());
      CHECK(!part.mesh.subsegments[part.mesh.descend(root, split.path)].is_leaf());
    }
    const Exceptions exceptions = find_exceptions(part.mesh, world.context().bounds);
    CHECK(exceptions.large.empty());
    for (const Exceptions::Item& item : exceptions.skinny)
      CHECK((item.cause == ExceptionCause::kInputAngle || item.cause == ExceptionCause::kShell));
    CHECK(triangulation_fault(part.mesh) == "");
  }
  MESSAGE("slept " << slept << " times, woken " << woken << ", slept through " << slept_through << ", moved asleep "
                   << moved);
  CHECK(woken > slept / 5);
  CHECK(slept_through > slept / 5);
  CHECK(moved > slept / 10);
}

TEST_CASE("sleep, moves and pauses change no bit of what is refined afterwards") {
  auto seeds = seeded_generator("one order of refinement");
  Unrest all;
  std::int64_t triangles = 0;
  const auto seen_all = [&] {
    return std::min({all.pauses, all.slept, all.moved, all.moved_asleep, all.woken, all.told_after_waking,
                     all.told_without_sleep}) > 20;
  };
  for (std::int64_t i = 0; more_cases(i, 40, seen_all()); ++i) {
    const std::uint64_t seed = seeds() % 100'000;
    CAPTURE(seed);
    RandomSubdomains world(seed, static_cast<int>(2 + seed % 9), 1500);
    SubdomainContext context = world.context();
    context.presplit = false;
    context.bounds.min_angle = seed % 3 == 0 ? 26 : 30;
    RestlessRounds quiet(context, 0), restless(context, seed + 1);
    for (const SubdomainId k : first_ids<SubdomainId>(world.size())) {
      quiet.add(k);
      restless.add(k);
    }
    quiet.run();
    restless.run();
    CHECK(quiet.states() == restless.states());
    triangles += quiet.triangles();
    const Unrest& more = restless.unrest();
    for (const auto count : {&Unrest::pauses, &Unrest::slept, &Unrest::moved, &Unrest::moved_asleep, &Unrest::woken,
                             &Unrest::told_after_waking, &Unrest::told_without_sleep})
      all.*count += more.*count;
  }
  MESSAGE(triangles << " triangles, " << all.pauses << " pauses, " << all.slept << " slept, " << all.moved << " moved, "
                    << all.moved_asleep << " moved asleep, " << all.woken << " woken, " << all.told_after_waking
                    << " told after waking, " << all.told_without_sleep << " told without sleep");
  CHECK(seen_all());
}

TEST_CASE("the order of a mesh that slept depends on the mesh alone") {
  auto seeds = seeded_generator("canonical order");
  for (std::int64_t i = case_count(40); i > 0; --i) {
    const std::uint64_t seed = seeds() % 100'000;
    CAPTURE(seed);
    RandomSubdomains world(seed, 2, 500);
    SubdomainMesh part = subdomain_triangulation(*world.context().decomposition, SubdomainId{0});
    Refiner(part.mesh, world.context().bounds).refine();
    const SubdomainMesh woken = DormantMesh(part).wake();
    CHECK(part.mesh.triangles.size() > 0);
    for (const SubdomainMesh& again : {DormantMesh(woken).wake(), [&] {
                                         SubdomainMesh renumbered = part;
                                         renumber(renumbered.mesh, GivenVertices::kFirst);
                                         return DormantMesh(renumbered).wake();
                                       }()}) {
      const auto same = [](const auto& a, const auto& b) {
        if (a.size() != b.size()) return false;
        return a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(*a.data())) == 0;
      };
      CHECK(same(again.mesh.triangles, woken.mesh.triangles));
      CHECK(same(again.mesh.points, woken.mesh.points));
      CHECK(same(again.mesh.region, woken.mesh.region));
      CHECK(same(again.mesh.subsegments, woken.mesh.subsegments));
    }
  }
}

TEST_CASE("large subdomains that move while refined in blocks end the same") {
  static_assert(1.25 * protocol::kMostPackedBytes + 100'000 < 0x1p31);
  Triangulation mesh = triangulate(generate_pipe({}));
  prepare_corners(mesh);
  DecomposeOptions options;
  options.subdomains = 1;
  const Decomposition d = decompose(mesh, options);
  const RadialField field(d.points.front(), 1e-3, 1e-3);
  for (const bool sized : {false, true}) {
    CAPTURE(sized);
    SubdomainContext context{&d, {}, false};
    context.bounds.plain.area = d.subdomains.front().area / 280'000;
    if (sized) context.bounds.size = &field;
    Subdomain stays(SubdomainId{0}, context), moves(SubdomainId{0}, context);
    std::vector<SplitPoint<GlobalRootId>> said;
    std::set<RefinerState::Stage> stages;
    for (const std::int64_t slice : {1, 40, 200, 600, 1000, 1000, 1000, 50'000, 50'000}) {
      stays.work(slice, said);
      moves.work(slice, said);
      const Bytes packed = moves.pack();
      stages.insert(unpack(packed).body->refiner.stage);
      // The size that balancing assumes, which decides whether a subdomain fits into a message.
      const double most = 1.25 * static_cast<double>(moves.packed_bytes()) + 100'000;
      CHECK(static_cast<double>(packed.size()) < most);
      moves = Subdomain::unpack(packed, context);
    }
    CHECK(stays.pack() == moves.pack());
    const SubdomainMesh& part = moves.mesh();
    for (const VertexId v : ids_of(part.points))  // also after vertices were sorted
      CHECK(part.mesh.points[v] == d.points[part.points[v]]);
    CHECK(stages.contains(RefinerState::Stage::kCoarse));
    CHECK(stages.contains(RefinerState::Stage::kFine));
  }
}
