// A rank that joins the work late, in virtual time: until then it neither receives nor sends.
#include <doctest/doctest.h>

#include <memory>
#include <vector>

#include "driftmesh/generate.hpp"
#include "mesh/exceptions.hpp"
#include "protocol/virtual_network.hpp"
#include "runtime/subdomain_loop.hpp"
#include "support/id_literals.hpp"
#include "support/late_plan.hpp"
#include "support/simulated_run.hpp"

using namespace driftmesh;
using namespace driftmesh::protocol;
using namespace driftmesh::testing;

namespace {

constexpr double kSpeed = 0.002;  // the same for each rank: runs take tenths of a second
constexpr const char* kPolicies[] = {"none", "zoltan", "diffusion", "stealing", "greedy"};

VirtualCluster slow_cluster(std::int32_t ranks) {
  VirtualCluster cluster;
  cluster.speeds.assign(to_index(ranks), kSpeed);
  cluster.step_limit = 20'000'000;
  return cluster;
}

/// Whether the late rank is sent a subdomain as soon as the others begin, whatever the policy says.
enum class Gift { kNone, kOneSubdomain };

/// A run in which one rank creates its loop later than the others.
class LateRun {
 public:
  LateRun(const RunPlan& plan, std::int32_t ranks, Rank late, double moment, Gift gift = Gift::kNone)
      : plan_(plan), late_(late), gift_(gift), network_(slow_cluster(ranks)), loops_(to_index(ranks)) {
    IdVector<Rank, RankStep> steps;
    for (const Rank r : first_ids<Rank>(ranks)) steps.push_back([=, this] { return step(r, r == late ? moment : 0); });
    REQUIRE(network_.run(steps).end == RunEnd::kFinished);
  }

  [[nodiscard]] const SubdomainLoop& loop(Rank r) const { return *loops_[r]; }
  [[nodiscard]] double makespan() const { return network_.makespan(); }

  void check_mesh() const {
    std::vector<const Subdomain*> all;
    for (const auto& loop : loops_)
      for (const auto& [id, subdomain] : loop->subdomains()) all.push_back(&subdomain);
    for (const std::string& problem : conformity_problems(plan_.decomposition, all)) FAIL_CHECK(problem);
    for (const Subdomain* s : all) {
      const Exceptions exceptions = find_exceptions(s->mesh().mesh, plan_.bounds);
      CHECK(exceptions.large.empty());
      CHECK(exceptions.skinny.empty());
    }
  }

 private:
  StepResult step(Rank r, double moment) {
    auto& loop = loops_[r];
    Transport& transport = network_.transport(r);
    if (loop) {
      for (auto s = loop->subdomains().begin(); gift_ == Gift::kOneSubdomain && s != loop->subdomains().end(); ++s)
        if (loop->hand_over(s->first, late_)) {
          gift_ = Gift::kNone;
          break;
        }
      return loop->step();
    }
    if (transport.now() < moment) {
      transport.spend((moment - transport.now()) * kSpeed);
      return StepResult::kBusy;
    }
    CostModel costs;
    costs.planning.unit.clear();  // on ranks as slow as these, planning would outlast the run
    loop = std::make_unique<SubdomainLoop>(transport, plan_, costs);
    return StepResult::kBusy;
  }

  const RunPlan& plan_;
  Rank late_;
  Gift gift_;  // still to be made
  VirtualNetwork network_;
  IdVector<Rank, std::unique_ptr<SubdomainLoop>> loops_;
};

RunPlan plan_for_late(std::int32_t ranks, const LateCase& late) {
  return late_plan(generate_holes({.columns = 3, .rows = 2}), 15'000, ranks, late);
}

/// The time that the others take for all their work.
double seconds_without(std::int32_t ranks, LateCase late) {
  late.policy = "none";
  const RunPlan plan = plan_for_late(ranks, late);
  return LateRun(plan, ranks, late.rank, 0).makespan();
}

}  // namespace

TEST_CASE("a late rank without subdomains gets work, and two or three ranks finish sooner for it") {
  for (const std::int32_t ranks : {2, 3, 8})
    for (const Rank rank : {0_rank, Rank{ranks - 1}})
      for (const char* policy : kPolicies)
        for (const double share : {0.1, 0.4}) {
          const LateCase late{policy, rank};
          CAPTURE(ranks);
          CAPTURE(rank);
          CAPTURE(late.policy);
          CAPTURE(share);
          const double alone = seconds_without(ranks, late);
          const RunPlan plan = plan_for_late(ranks, late);
          const LateRun run(plan, ranks, rank, share * alone);
          run.check_mesh();
          const bool gives = late.policy != "none";
          CHECK((run.loop(rank).protocol().counters().arrivals > 0) == gives);
          CHECK((run.loop(rank).times().computing > 0) == gives);
          if (gives && ranks < 8) CHECK(run.makespan() < alone);
        }
}

TEST_CASE("a run waits for a late rank when all work could be done; it gets what was sent to it, and no more") {
  for (const Rank rank : {0_rank, 2_rank})
    for (const char* policy : kPolicies)
      for (const Gift gift : {Gift::kNone, Gift::kOneSubdomain}) {
        const LateCase late{policy, rank};
        CAPTURE(rank);
        CAPTURE(late.policy);
        CAPTURE(static_cast<int>(gift));
        const double moment = 2 * seconds_without(3, late);
        const RunPlan plan = plan_for_late(3, late);
        const LateRun run(plan, 3, rank, moment, gift);
        run.check_mesh();
        CHECK(run.makespan() > moment);
        // Nobody has heard of it, so no policy gives it anything.
        const int sent = gift == Gift::kOneSubdomain ? 1 : 0;
        CHECK(run.loop(rank).protocol().counters().arrivals == sent);
        CHECK((run.loop(rank).times().computing > 0) == (sent > 0));
      }
}

TEST_CASE("a late rank with subdomains finds them, and all messages to them") {
  for (const std::int32_t ranks : {2, 3, 8})
    for (const LateStart start : {LateStart::kOneSubdomain, LateStart::kShare})
      for (const char* policy : kPolicies)
        for (const double share : {0.3, 3.0}) {
          const LateCase late{policy, Rank{ranks - 1}, start};
          CAPTURE(ranks);
          CAPTURE(late.policy);
          CAPTURE(share);
          const double moment = share * seconds_without(ranks, late);
          const RunPlan plan = plan_for_late(ranks, late);
          const LateRun run(plan, ranks, late.rank, moment);
          run.check_mesh();
          CHECK(run.makespan() > moment);
          // It finds the advice of others, too, and may give away its only subdomain before it works.
          const auto& counters = run.loop(late.rank).protocol().counters();
          const bool gave_all = counters.hand_offs > 0 && start == LateStart::kOneSubdomain;
          CHECK((run.loop(late.rank).times().computing > 0 || gave_all));
          CHECK(counters.splits_handled > 0);
          if (start == LateStart::kOneSubdomain && share < 1)
            CHECK((run.loop(late.rank).protocol().counters().arrivals > 0) == (late.policy != "none"));
        }
}
