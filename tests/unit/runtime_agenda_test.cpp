#include <doctest/doctest.h>

#include <vector>

#include "runtime/agenda.hpp"
#include "support/id_literals.hpp"

using namespace driftmesh;

TEST_CASE("the agenda finishes what was begun, and takes refined subdomains last") {
  Agenda agenda(WorkOrder::kLargest);
  CHECK(!agenda.first());
  agenda.put({1_sub, false, false, 10, 0});
  agenda.put({2_sub, false, false, 30, 0});
  agenda.put({3_sub, false, true, 99, 5});
  agenda.put({4_sub, true, false, 1, 0});
  CHECK(agenda.first() == 4_sub);
  agenda.remove(4_sub);
  CHECK(agenda.first() == 2_sub);
  agenda.put({1_sub, false, false, 40, 0});
  CHECK(agenda.first() == 1_sub);
  agenda.remove(1_sub);
  agenda.remove(2_sub);
  CHECK(agenda.first() == 3_sub);
  agenda.put({5_sub, false, true, 1, 6});
  CHECK(agenda.first() == 5_sub);
  CHECK(agenda.size() == 2);
}

TEST_CASE("each order of work has its own, within what was begun, new and refined") {
  for (const WorkOrder order : {WorkOrder::kGiven, WorkOrder::kLargest, WorkOrder::kBacklog}) {
    Agenda agenda(order);
    agenda.put({1_sub, false, false, 10, 5});
    agenda.put({2_sub, false, false, 30, 1});
    agenda.put({3_sub, false, false, 20, 9});
    agenda.put({4_sub, false, true, 99, 2});
    agenda.put({5_sub, false, true, 1, 7});
    agenda.put({6_sub, true, false, 1, 0});
    const std::vector<SubdomainId> expected =
        order == WorkOrder::kGiven     ? std::vector{6_sub, 1_sub, 2_sub, 3_sub, 5_sub, 4_sub}
        : order == WorkOrder::kLargest ? std::vector{6_sub, 2_sub, 3_sub, 1_sub, 5_sub, 4_sub}
                                       : std::vector{6_sub, 3_sub, 1_sub, 2_sub, 5_sub, 4_sub};
    CHECK(agenda.in_order() == expected);
    agenda.put({3_sub, true, false, 20, 9});  // moves up, and is there once
    CHECK(agenda.size() == 6);
    CHECK(agenda.first() == 3_sub);
    agenda.clear();
    CHECK(agenda.empty());
    agenda.remove(3_sub);
    agenda.put({3_sub, false, false, 20, 9});
    CHECK(agenda.in_order() == std::vector{3_sub});
    agenda.remove(3_sub);
    CHECK(agenda.empty());
    agenda.remove(3_sub);
  }
}
