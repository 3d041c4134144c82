// When a rank reports and plans, and what planning is charged for.
#include <doctest/doctest.h>

#include <vector>

#include "balancer/load_reporter.hpp"
#include "balancer/snapshot/effort.hpp"
#include "balancer/trigger/planning_pace.hpp"
#include "controller_fixture.hpp"

using namespace driftmesh;
using namespace driftmesh::balancer;
using namespace driftmesh::testing;

TEST_CASE("a rank reports that it has finished as foreseen, and that it has work again") {
  ReportRule rule(0.02, 5, 0.1);
  rule.told(0, 1000, 100);
  CHECK(!rule.due(4, 600, 100, false));
  CHECK(rule.due(4, 0, 100, false));
  CHECK(rule.due(10, 0, 100, false));
  rule.told(10, 0, 100);
  CHECK(!rule.due(11, 0, 0, false));
  CHECK(rule.due(11, 1, 0, false));
  CHECK(!rule.due(100, 0, 100, false));
}

TEST_CASE("a report is due when there are other subdomains, and says each thing once") {
  ControllerOptions options;
  options.gap = 1, options.interval = 100;
  LoadReporter reporter(options);
  const auto due = [&](double now, const Loads& own) {
    return reporter.due({.now = now, .own = own, .speed = 10, .doubt = 0.5, .free_memory = 70}, own);
  };
  const auto first = due(0, loads_of(1, 3, 1000));
  REQUIRE(first);
  CHECK(first->list == LoadReport{1, 0, 10, loads_of(1, 3, 1000), 0.5, 0, 70});
  CHECK(first->sum == LoadReport{1, 0, 10, {}, 0.5, 3000, 70});
  CHECK(!due(2, loads_of(1, 3, 1000)));
  CHECK(!due(2, {{3_sub, 0, 1500, 40}, {1_sub, 0, 1500, 40}}));  // fewer, as foreseen
  CHECK(due(2, {{3_sub, 0, 1500, 40}, {4_sub, 0, 1500, 40}}));
  CHECK(!due(4, {{3_sub, 0, 1500, 40}, {4_sub, 0, 1500, 40}}));
  reporter.acted_on(7);
  reporter.acted_on(6);
  reporter.mention(9_sub, 2);
  reporter.mention(4_sub, 5);  // still here: its load says more
  const auto second = due(6, loads_of(3, 4, 1500));
  REQUIRE(second);
  CHECK(second->list.round == 3);
  CHECK(second->list.plan == 7);
  CHECK(second->list.loads == Loads{{3_sub, 0, 1500, 40}, {4_sub, 0, 1500, 40}, {9_sub, 2, 0, 0}});
  CHECK(second->sum.loads == Loads{{9_sub, 2, 0, 0}, {4_sub, 5, 0, 0}});
  CHECK(second->sum.unlisted == 3000);
  CHECK(!due(8, loads_of(3, 4, 1500)));
  reporter.has_changed();
  const auto third = due(10, loads_of(3, 4, 1500));
  REQUIRE(third);
  CHECK(third->list.loads == loads_of(3, 4, 1500));
  CHECK(!due(12, loads_of(3, 4, 1500)));
}

TEST_CASE("plans without effect become rarer, and planning takes no more than its share") {
  ControllerOptions options;
  options.gap = 1, options.interval = 5, options.overhead = 0.01;
  PlanningPace pace(options, 10);
  CHECK(pace.due(10));
  CHECK(!pace.due(9));
  double now = 10;
  for (const double pause : {2.0, 4.0, 5.0, 5.0}) {
    pace.planned(now, false);
    CHECK(!pace.due(now + pause - 0.01));
    CHECK(pace.due(now + pause));
    now += pause;
  }
  pace.looked(now);
  CHECK(pace.due(now + 1));
  pace.planned(now, true);
  CHECK(pace.due(now + 1));
  pace.planned(now, false);
  CHECK(!pace.due(now + 1.99));
  CHECK(pace.due(now + 2));  // begins anew
  pace.took(0.5);
  CHECK(pace.cost_of_planning() == 0.5);
  CHECK(!pace.due(now + 49));
  CHECK(pace.due(now + 50));
  pace.looked(now + 50);
  pace.took(0.001);
  CHECK(pace.cost_of_planning() == 0.5);  // what a plan takes, not a look
  CHECK(pace.due(now + 51));
}

TEST_CASE("efforts add up in the innermost log") {
  note_effort("weigh", 1);  // nobody listens
  EffortLog outer;
  note_effort("weigh", 2);
  {
    EffortLog inner;
    note_effort("weigh", 30);
    note_effort("weigh", 5);
    note_effort("deal", 7);
    CHECK(inner.efforts() == Efforts{{"weigh", 35}, {"deal", 7}});
  }
  note_effort("weigh", 4);
  CHECK(outer.efforts() == Efforts{{"weigh", 6}});
  PlanningCosts costs;
  costs.unit = {{"weigh", 0.5}, {"deal", 3}};
  CHECK(costs.seconds({{"weigh", 6}, {"deal", 2}, {"unknown", 9}}) == 9);
}
