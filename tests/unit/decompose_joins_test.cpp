#include <doctest/doctest.h>

#include <array>
#include <cstdint>

#include "decompose/decompose.hpp"
#include "decompose/with_joins.hpp"
#include "support/prepared_mesh.hpp"

// What becomes of the values of subdomains that become one.

using namespace driftmesh;

TEST_CASE("what becomes one subdomain has the area and the forecast of all, and the region of the largest") {
  Pslg strip;
  strip.points = {{0, 0}, {3, 0}, {3, 1}, {0, 1}};
  strip.segments = {{0, 1, 1}, {1, 2, 1}, {2, 3, 1}, {3, 0, 1}};
  Decomposition d = decompose(testing::prepared(strip), {.subdomains = 3, .bounds = {}});
  const IdVector<SubdomainId, SubdomainId> all_in_one(3, SubdomainId{0});
  for (const std::size_t largest : {0U, 1U, 2U}) {
    CAPTURE(largest);
    for (std::size_t i = 0; i < 3; ++i)
      d.subdomains[static_cast<SubdomainId>(i)] = {.area = i == largest ? 4.0 : 2.0,
                                                   .predicted = std::array{10.0, 200.0, 3000.0}[i],
                                                   .centroid = {i == largest ? 1.0 : 3.0, 0.5},
                                                   .region = static_cast<std::uint16_t>(7 + i)};
    const Decomposition joined = with_joins(d, all_in_one).decomposition;
    REQUIRE(joined.size() == 1);
    const Decomposition::Subdomain& whole = joined.subdomains[SubdomainId{0}];
    CHECK(whole.area == 8);
    CHECK(whole.predicted == 3210);
    CHECK(whole.region == 7 + largest);
    CHECK(whole.centroid.x == doctest::Approx(2));
    CHECK(whole.centroid.y == doctest::Approx(0.5));
  }
}
