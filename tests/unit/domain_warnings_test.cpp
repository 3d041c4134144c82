
#include <doctest/doctest.h>

#include <algorithm>
#include <initializer_list>
#include <string>
#include <vector>

#include "mesh/cdt.hpp"
#include "support/warnings_of.hpp"

using namespace driftmesh;
using testing::warnings_of;

namespace {

void add_chain(Pslg& pslg, std::initializer_list<Point> points, bool closed) {
  const auto first = static_cast<std::int32_t>(pslg.points.size());
  const auto count = static_cast<std::int32_t>(points.size());
  pslg.points.insert(pslg.points.end(), points);
  for (std::int32_t i = 0; i + 1 < count; ++i) pslg.segments.push_back({first + i, first + i + 1, 1});
  if (closed) pslg.segments.push_back({first + count - 1, first, 1});
}

Pslg plain_square() {
  Pslg pslg;
  add_chain(pslg, {{0, 0}, {4, 0}, {4, 4}, {0, 4}}, true);
  return pslg;
}

}  // namespace

TEST_CASE("a chain outside the boundary is left out with a warning") {
  Pslg pslg = plain_square();
  CHECK(warnings_of(pslg).empty());
  add_chain(pslg, {{5, 0}, {6, 1}, {6, 2}}, false);
  REQUIRE(warnings_of(pslg).size() == 1);
  CHECK(
      warnings_of(pslg)[0] ==
      "2 segments bound no part of the domain and are left out: the chain is open at vertex 5 (5, 0); its ends (5, 0) "
      "and (6, 2) are 2.24 apart; close the gap, or have the input snapped by more than that");
}

TEST_CASE("an outline that is open beside a closed ring is named with its gap") {
  Pslg pslg = plain_square();
  add_chain(pslg, {{-10, -10}, {10, -10}, {10, 10}, {-10, 10}, {-10, -9.5}}, false);
  REQUIRE(warnings_of(pslg).size() == 1);
  CHECK(warnings_of(pslg)[0] ==
        "4 segments bound no part of the domain and are left out: the chain is open at vertex 5 (-10, -10); its ends "
        "(-10, -10) and (-10, -9.5) are 0.5 apart; close the gap, or have the input snapped by more than that");
  pslg.holes = {{1, 1}};
  CHECK_THROWS_WITH(static_cast<void>(warnings_of(pslg)),
                    "the hole points remove the whole domain: each of them must lie inside a closed ring of segments, "
                    "but some chain of segments is open: its ends (-10, -10) and (-10, -9.5) are 0.5 apart; close the "
                    "gap, or have the input snapped by more than that");
}

TEST_CASE("a chain in a hole is left out with a warning") {
  Pslg pslg = plain_square();
  add_chain(pslg, {{1, 1}, {3, 1}, {3, 3}, {1, 3}}, true);
  add_chain(pslg, {{2, 2}, {2.5, 2.5}}, false);
  pslg.holes = {{1.5, 2.5}};
  REQUIRE(warnings_of(pslg).size() == 1);
  CHECK(warnings_of(pslg)[0].starts_with("1 segment bounds no part of the domain and is left out"));
}

TEST_CASE("regions that meet through a gap are named with the gap, in any order of the segments") {
  Pslg pslg = plain_square();
  add_chain(pslg, {{1, 1}, {3, 1}, {3, 3}, {1, 3}}, false);
  pslg.regions = {{{2, 2}, 1, 0.001}, {{0.5, 0.5}, 2, 1}};
  for (int order = 0; order < 2; ++order) {
    REQUIRE(warnings_of(pslg).size() == 1);
    CHECK(warnings_of(pslg)[0].find("regions 1 at (2, 2) and 2 at (0.5, 0.5)") == 0);
    CHECK(warnings_of(pslg)[0].find("open at vertex 5 (1, 1)") != std::string::npos);
    std::reverse(pslg.segments.begin(), pslg.segments.end());
  }
  pslg.segments.push_back({7, 4, 1});
  CHECK(warnings_of(pslg).empty());
}

TEST_CASE("rings that are neither holes nor regions are warned of") {
  Pslg pslg = plain_square();
  add_chain(pslg, {{1, 1}, {2, 1}, {2, 2}}, true);
  REQUIRE(warnings_of(pslg).size() == 1);
  CHECK(warnings_of(pslg)[0].starts_with("1 closed ring inside the domain, at vertex 5 (1, 1)"));
  Pslg with_hole = pslg;
  with_hole.holes = {{1.8, 1.5}};
  CHECK(warnings_of(with_hole).empty());
  Pslg with_region = pslg;
  with_region.regions = {{{1.8, 1.5}, 1, -1}};
  CHECK(warnings_of(with_region).empty());
  Pslg region_around = pslg;
  region_around.regions = {{{3.5, 3.5}, 1, -1}};
  CHECK(warnings_of(region_around).size() == 1);
}

TEST_CASE("segments that divide the domain from border to border are no rings") {
  Pslg pslg = plain_square();
  for (const double at : {1.0, 2.0, 3.0}) {
    add_chain(pslg, {{at, 0}, {at, 4}}, false);
    add_chain(pslg, {{0, at}, {4, at}}, false);
  }
  CHECK(warnings_of(pslg).empty());
  Pslg repaired = pslg;
  static_cast<void>(repair(repaired));
  CHECK(find_nested_rings(triangulate(repaired)).alternating_holes.empty());
}
