#include "mapping/mapping.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <numeric>

#include "decompose/decompose.hpp"
#include "driftmesh/error.hpp"
#include "mesh/cdt.hpp"
#include "support/id_literals.hpp"

using namespace driftmesh;

namespace {

Decomposition square_in(int subdomains) {
  Pslg pslg;
  pslg.points = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  pslg.segments = {{0, 1, 1}, {1, 2, 1}, {2, 3, 1}, {3, 0, 1}};
  DecomposeOptions options;
  options.subdomains = subdomains;
  return decompose(triangulate(pslg), options);
}

}  // namespace

TEST_CASE("graph mapping balances work and keeps interfaces between ranks short") {
  const Decomposition d = square_in(800);
  for (const int ranks : {1, 2, 3, 8, 9, 32}) {
    CAPTURE(ranks);
    MappingOptions options;
    options.ranks = ranks;
    const Assignment assignment = map_subdomains(d, options);
    REQUIRE(assignment.size() == d.size());
    const MappingReport report = report_mapping(d, assignment, options);
    CHECK(report.largest_load < 1.12);
    CHECK(report.interface_length <= 1.6 * (2 * std::sqrt(ranks) - 2) + 1e-9);  // a grid of squares has 2 sqrt(P) - 2
    options.method = MappingMethod::kRoundRobin;
    const MappingReport worst = report_mapping(d, map_subdomains(d, options), options);
    if (ranks > 1) CHECK(worst.interface_length > 3 * report.interface_length);
    CHECK(assignment == map_subdomains(d, {ranks, {}, MappingMethod::kGraph}));
  }
}

TEST_CASE("work follows the speeds of the ranks") {
  const Decomposition d = square_in(400);
  for (const MappingMethod method : {MappingMethod::kGraph, MappingMethod::kBlock}) {
    MappingOptions options{4, {1, 1, 2, 4}, method};
    const Assignment assignment = map_subdomains(d, options);
    CHECK(report_mapping(d, assignment, options).largest_load < 1.06);
    IdVector<Rank, double> work(4);
    for (const SubdomainId i : ids_of(assignment)) work[assignment[i]] += d.subdomains[i].predicted;
    const double all = std::accumulate(work.begin(), work.end(), 0.0);
    CHECK(work.back() / all == doctest::Approx(0.5).epsilon(0.04));
  }
}

TEST_CASE("absent ranks get nothing, and the others what they would get without them") {
  const Decomposition d = square_in(400);
  for (const MappingMethod method : {MappingMethod::kGraph, MappingMethod::kBlock, MappingMethod::kRoundRobin}) {
    const Assignment without = map_subdomains(d, {2, {1, 3}, method});
    MappingOptions options{5, {9, 1, 9, 3, 9}, method};
    options.absent = {true, false, true, false, true};
    const Assignment assignment = map_subdomains(d, options);
    for (const SubdomainId i : ids_of(assignment)) REQUIRE(assignment[i] == (without[i] == 0_rank ? 1_rank : 3_rank));
    CHECK(report_mapping(d, assignment, options).largest_load ==
          doctest::Approx(report_mapping(d, without, {2, {1, 3}, method}).largest_load));
    options.absent.assign(5, true);
    CHECK_THROWS_AS(static_cast<void>(map_subdomains(d, options)), Error);
  }
}

TEST_CASE("area can be balanced instead of work") {
  Decomposition d = square_in(400);
  for (const SubdomainId i : first_ids<SubdomainId>(40))
    d.subdomains[i].predicted *= 50;  // like a size field that is fine in a corner
  for (const MappingMethod method : {MappingMethod::kGraph, MappingMethod::kBlock}) {
    MappingOptions options{4, {}, method, MappingWeight::kArea};
    const Assignment assignment = map_subdomains(d, options);
    IdVector<Rank, double> area(4);
    for (const SubdomainId i : ids_of(assignment)) area[assignment[i]] += d.subdomains[i].area;
    for (const double a : area) CHECK(a == doctest::Approx(0.25).epsilon(0.06));
    CHECK(report_mapping(d, assignment, options).largest_load > 1.5);
  }
}

TEST_CASE("blocks are consecutive and use every rank") {
  const Decomposition d = square_in(100);
  const Assignment assignment = map_subdomains(d, {7, {}, MappingMethod::kBlock});
  CHECK(assignment.front() == Rank{0});
  CHECK(assignment.back() == Rank{6});
  Rank last{0};
  for (const Rank rank : assignment) {
    CHECK(rank >= last);
    CHECK(rank <= after(last));
    last = rank;
  }
}

TEST_CASE("more ranks than subdomains: one each") {
  const Decomposition d = square_in(5);
  const Assignment assignment = map_subdomains(d, {8, {}, MappingMethod::kGraph});
  CHECK(assignment == Assignment{0_rank, 1_rank, 2_rank, 3_rank, 4_rank});
}

TEST_CASE("mapping options out of range are rejected") {
  const Decomposition d = square_in(5);
  CHECK_THROWS_AS(static_cast<void>(map_subdomains(d, {0, {}, MappingMethod::kGraph})), Error);
  CHECK_THROWS_WITH_AS(static_cast<void>(map_subdomains(d, {3, {1, 2}, MappingMethod::kGraph})),
                       doctest::Contains("2 speeds"), Error);
  CHECK_THROWS_AS(static_cast<void>(map_subdomains(d, {2, {1, 0}, MappingMethod::kGraph})), Error);
}
