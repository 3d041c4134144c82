#include <doctest/doctest.h>

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "balancer/policies/policy_factory.hpp"
#include "protocol/virtual_network.hpp"
#include "runtime_fixture.hpp"
#include "support/simulated_crew.hpp"
#include "support/value_digest.hpp"

// Balanced runs in virtual time, to the last bit: what ranks measure, report, plan and move decides each of them.
// Tables of balancing are made of such runs.

using namespace driftmesh;
using namespace driftmesh::testing;

namespace {

struct BalancedCase {
  IdVector<Rank, double> speeds;
  Presplit presplit = Presplit::kOn;
  bool sleep = false;
  std::size_t crew = 0;                    ///< threads that help each rank
  std::int64_t max_triangles = INT64_MAX;  ///< on each rank
  bool on_one_rank = false;                ///< at the start
};

/// Of all times, counts and owners of a run.
std::uint64_t digest_of_run(const BalancedCase& c, const std::string& policy, std::int64_t& moved) {
  const auto ranks = static_cast<std::int32_t>(c.speeds.size());
  RunPlan plan = plan_of(ell(), {20, {1e-4}, {}, nullptr}, ranks, 60, c.presplit);
  for (const SubdomainId i : ids_of(plan.owners))
    plan.owners[i] = c.on_one_rank ? Rank{0} : Rank{to_int(i) * ranks / 60};
  plan.work.slice = 500;
  plan.work.sleep = c.sleep;
  plan.max_triangles = c.max_triangles;
  plan.balancing.policy = policy;
  prepare_balancing(plan, ranks, balancer::make_policy);
  CostModel slow;  // enough for reports and plans to matter
  slow.point *= 100;
  slow.packed_byte *= 10;
  protocol::VirtualNetwork network({c.speeds, {}, 1e-6, 1e-6});
  std::vector<std::unique_ptr<SimulatedCrew>> crews;
  SimulatedRanks run(network, ranks, plan, slow);
  for (const auto& loop : run.loops)
    if (c.crew > 0) loop->hire(*crews.emplace_back(std::make_unique<SimulatedCrew>(c.crew, crews.size() + 1)));
  REQUIRE(network.run(run.steps).end == protocol::RunEnd::kFinished);
  ValueDigest digest;
  for (const Rank r : ids_of(run.loops)) {
    const RankOutcome outcome = run.loops[r]->outcome();
    for (const double seconds : {network.clock(r), outcome.times.computing, outcome.times.sending,
                                 outcome.times.polling, outcome.times.balancing, outcome.times.idle})
      digest.add(seconds);
    for (const std::int64_t count :
         {outcome.triangles, outcome.interface_splits, outcome.counters.hand_offs, outcome.counters.hand_off_bytes,
          outcome.counters.splits_sent, outcome.counters.batches_sent})
      digest.add(count);
    digest.add(outcome.messages);
    digest.add(outcome.message_bytes);
    for (const auto& held : run.loops[r]->subdomains()) digest.add(std::int64_t{to_int(held.first)});
    moved += outcome.counters.hand_offs;
  }
  return digest.value();
}

}  // namespace

TEST_CASE("balanced runs are what they were, to the last bit") {
  const std::vector<BalancedCase> cases{
      {.speeds = {1, 1, 0.25}},
      {.speeds = {1, 0.5, 1, 0.5}, .presplit = Presplit::kOff, .sleep = true, .max_triangles = 14'000},
      {.speeds = {1, 1}, .crew = 2, .on_one_rank = true},
      {.speeds = {1, 0.1, 1}, .max_triangles = 20'000, .on_one_rank = false}};
  const std::vector<std::pair<std::string, std::vector<std::uint64_t>>> recorded{
      {"none", {0x22a8adb982bffeba, 0x88b95baf393b2998, 0xd24044b4023173b7, 0x6be15dba947a6211}},
      {"stealing", {0x46385c24425de2e6, 0x6569a1fe865bc36f, 0x7969558a89405178, 0x6d0a90e4237349cc}},
      {"diffusion", {0x911bf611fc46c706, 0xce2b7ea90e22e084, 0x3dc8f12f56bd0ef8, 0x8b240ae46ba25edc}},
      {"greedy", {0xa5c671ca3b41d3ee, 0x58e29fa9f2924bb1, 0xf9f545ba2274a7a0, 0x33db840bc544d502}}};
  for (const auto& [policy, digests] : recorded)
    for (std::size_t k = 0; k < cases.size(); ++k) {
      CAPTURE(policy);
      CAPTURE(k);
      std::int64_t moved = 0;
      CHECK(digest_of_run(cases[k], policy, moved) == digests[k]);
      CHECK((moved > 0) == (policy != "none"));
    }
}
