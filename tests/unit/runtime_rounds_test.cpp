#include <doctest/doctest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <thread>
#include <utility>
#include <vector>

#include "driftmesh/policy.hpp"
#include "runtime/threads/refinement_in_rounds.hpp"
#include "runtime_fixture.hpp"
#include "support/id_literals.hpp"
#include "support/refine_together.hpp"

// Refinement in rounds: what its threads count and know, in all rounds and parts of rounds.

using namespace driftmesh;
using namespace driftmesh::testing;

namespace {

/// For threads that give each other nothing: the first half of the subdomains is the first one's, and so on.
RunPlan plan_for_threads(std::int32_t threads) {
  RunPlan plan = plan_of(ell(), {20, {2e-3}, {}, nullptr}, threads, 8, Presplit::kOff);
  plan.work.slice = 10;
  deal_to_threads(plan, threads);
  return plan;
}

const std::vector<const SizeField*>& no_fields(std::int32_t threads) {
  static const std::vector<const SizeField*> kNone[] = {{}, {nullptr}, {nullptr, nullptr}};
  return kNone[threads];
}

std::int64_t triangles_of(const std::map<SubdomainId, Subdomain>& subdomains) {
  std::int64_t sum = 0;
  for (const auto& [id, subdomain] : subdomains) sum += subdomain.triangles();
  return sum;
}

/// A length everywhere, and the threads that have asked for it.
struct AskedField final : SizeField {
  [[nodiscard]] double edge_length(const Point&) const override {
    const std::lock_guard lock(alone);
    askers.insert(std::this_thread::get_id());
    return 0.1;
  }
  mutable std::mutex alone;
  mutable std::set<std::thread::id> askers;
};

/// Work that is stopped at the first fence where `enough`, subdomain by subdomain.
std::map<SubdomainId, Bytes> stopped_when(const RunPlan& plan,
                                          const std::function<bool(const RefinementInRounds&)>& enough) {
  struct Stopped {};
  std::map<SubdomainId, Bytes> kept;
  RefinementInRounds* refinement = nullptr;
  RefinementInRounds::Watch watch;
  watch.halts = [] { return true; };
  watch.fence = [&](bool rests) {
    if (!enough(*refinement)) return rests;
    for (const SubdomainId s : refinement->here()) kept[s] = refinement->halted(s);
    throw Stopped();
  };
  RefinementInRounds made(plan, no_fields(1), watch);
  refinement = &made;
  CHECK_THROWS_AS(made.run(), Stopped);
  return kept;
}

/// Moves nothing, and tells what each rank knows from the start.
class Onlooker final : public balancer::Policy {
 public:
  explicit Onlooker(std::function<void(const balancer::Layout&)> look) : look_(std::move(look)) {}
  [[nodiscard]] balancer::Placement placement() const override { return balancer::Placement::kNeighbors; }
  [[nodiscard]] std::vector<balancer::Move> plan(const balancer::LoadSnapshot& snapshot, Rank) const override {
    look_(*snapshot.layout);
    return {};
  }

 private:
  std::function<void(const balancer::Layout&)> look_;
};

}  // namespace

TEST_CASE("a thread counts what it did in all parts of all rounds, and what it has in the end") {
  const RunPlan plan = plan_for_threads(1);
  int slices = 0;
  constexpr auto kSlice = std::chrono::milliseconds(1);
  RefinementInRounds::Watch watch;
  watch.check = [&](std::int64_t) {
    ++slices;
    std::this_thread::sleep_for(kSlice);
  };
  watch.halts = [] { return true; };
  watch.fence = [](bool rests) { return rests; };
  RefinementInRounds refinement(plan, no_fields(1), watch);
  refinement.run();
  const RankOutcome& outcome = refinement.outcomes()[0_rank];
  CHECK(refinement.rounds() > 1);
  CHECK(slices > 20);
  CHECK(outcome.times.computing >= slices * std::chrono::duration<double>(kSlice).count());
  CHECK(outcome.triangles == triangles_of(refinement.subdomains()));
  CHECK(outcome.subdomains == 8);
  CHECK(outcome.interface_splits > 0);  // in the last round there are none

  std::uint64_t digest = 0, expected = 0;
  for (const auto& [id, subdomain] : refinement.subdomains()) digest += mesh_digest(subdomain.mesh().mesh);
  for (const SubdomainMesh& part : refine_together(plan.decomposition, plan.bounds).parts)
    expected += mesh_digest(part.mesh);
  CHECK(digest == expected);
}

TEST_CASE("threads agree on the end of each part of a round, and are asked with the triangles of all") {
  const RunPlan plan = plan_for_threads(2);
  std::atomic<std::int64_t> most = 0;
  std::uint64_t parts = 0;
  RefinementInRounds::Watch watch;
  watch.check = [&](std::int64_t made) {
    for (std::int64_t known = most; known < made && !most.compare_exchange_weak(known, made);) {
    }
  };
  watch.halts = [] { return true; };
  watch.fence = [&](bool rests) {
    ++parts;
    return rests;
  };
  RefinementInRounds refinement(plan, no_fields(2), watch);
  refinement.run();
  CHECK(most == triangles_of(refinement.subdomains()));
  CHECK(parts > 10);
  // One probe at least, the pass and the end.
  CHECK(refinement.outcomes()[0_rank].messages >= 3 * parts);
}

TEST_CASE("each thread asks its own size field, and none that of the plan") {
  RunPlan plan = plan_for_threads(2);
  const AskedField of_plan, one, other;
  plan.bounds.size = &of_plan;
  const std::vector<const SizeField*> fields{&one, &other};
  RefinementInRounds refinement(plan, fields, {});
  refinement.run();
  CHECK(one.askers == std::set{std::this_thread::get_id()});
  CHECK(other.askers.size() == 1);
  CHECK(other.askers != one.askers);
  CHECK(of_plan.askers.empty());
}

TEST_CASE("who goes on with stopped work counts its rounds, too") {
  const RunPlan plan = plan_for_threads(1);
  RefinementInRounds whole(plan, no_fields(1), {});
  whole.run();
  REQUIRE(whole.rounds() > 1);
  RefinementInRounds rest(plan, no_fields(1), {});
  const auto in_second = [](const RefinementInRounds& refinement) { return refinement.rounds() == 2; };
  for (const auto& [s, bytes] : stopped_when(plan, in_second)) rest.take_up(s, bytes);
  rest.run();
  CHECK(rest.rounds() == whole.rounds());
}

TEST_CASE("the balancer of stopped work knows who has it, and what is left of it") {
  RunPlan plan = plan_for_threads(1);
  const auto in_the_middle = [](const RefinementInRounds& refinement) { return refinement.triangles() > 500; };
  const std::map<SubdomainId, Bytes> stopped = stopped_when(plan, in_the_middle);
  // The first of two threads has everything, though the plan was made for both.
  plan.layout = layout_of(plan_for_threads(2), 2);
  const SubdomainContext context = context_of(plan);
  std::map<SubdomainId, double> left;
  for (const auto& [s, bytes] : stopped) {
    ByteReader reader(bytes);
    static_cast<void>(reader.number<std::int32_t>());  // the round
    Bytes packed;
    reader.array(packed);
    left[s] = Subdomain::unpack(packed, context).remaining();
  }
  std::atomic<int> looks = 0;
  const auto look = [&](const balancer::Layout& layout) {
    if (looks > 0) return;
    bool all = true;
    for (const auto& [s, remaining] : left) all = all && layout[s].owner == 0_rank && layout[s].predicted == remaining;
    CHECK(all);
    ++looks;
  };
  plan.policy = std::make_shared<const Onlooker>(look);
  plan.balancing.options.look = plan.balancing.options.gap = 0;
  RefinementInRounds::Watch watch;
  watch.check = [&](std::int64_t) {  // no work is done before the other thread has looked around
    while (looks == 0) std::this_thread::yield();
  };
  RefinementInRounds refinement(plan, no_fields(2), watch);
  for (const auto& [s, bytes] : stopped) refinement.take_up(s, bytes);
  refinement.run();
  CHECK(looks > 0);
}
