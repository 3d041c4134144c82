#include <doctest/doctest.h>

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
