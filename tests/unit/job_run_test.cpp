#include <doctest/doctest.h>

#include <cstdint>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

#include "balancer/policies/policy_factory.hpp"
#include "driftmesh/error.hpp"
#include "job/check.hpp"
#include "job/domain.hpp"
#include "job/one_piece.hpp"
#include "job/order.hpp"
#include "job/prepare.hpp"
#include "job/record.hpp"
#include "job/simulated/run_simulated.hpp"
#include "job/thread_run.hpp"
#include "job/triangulated.hpp"
#include "mesh/digest.hpp"
#include "pslg/generators.hpp"
#include "support/lone_team.hpp"

// The path from a request to a mesh, at every place that needs no MPI.

using namespace driftmesh;
using namespace driftmesh::job;

namespace {

Request pipe() {
  Request request;
  request.input.generator = "pipe";
  request.bounds.triangles = 2e4;
  return request;
}

Request bay() {
  Request request;
  request.input.generator = "bay";
  request.input.parameters = {{"resolution", "400"}};
  return request;
}

Limits limits_of(const Request& request) {
  Limits limits;
  limits.triangles = request.limits.max_triangles;
  return limits;
}

Prepared prepared(const Request& request, const Domain& domain, Place place, std::size_t ranks,
                  const Limits& limits = {}) {
  Watch watch;
  const Triangulated triangulated =
      triangulate_domain(request, domain, static_cast<std::int32_t>(ranks), Cut::kAlways, watch);
  return prepare(request, domain, triangulated, {.policies = balancer::make_policy}, place,
                 IdVector<Rank, double>(ranks, 1.0), limits, watch);
}

Prepared prepared(const Request& request, Place place, std::size_t ranks, const Limits& limits = {}) {
  Watch watch;
  const Domain domain = read_domain(request, {}, watch);
  return prepared(request, domain, place, ranks, limits);
}

OnePiece meshed(const Request& request, const Domain& domain, Watch& watch) {
  return mesh_in_one_piece(request, domain, triangulate_domain(request, domain, 1, Cut::kNever, watch), false, watch);
}

OnePiece meshed(const Request& request) {
  Watch watch;
  return meshed(request, read_domain(request, {}, watch), watch);
}

/// The record of a mesh made in subdomains by threads of this process.
RunRecord made_by_threads(const Request& request, std::int32_t threads, Watch& watch) {
  Domain domain = read_domain(request, {}, watch);
  Order order;
  order.plan = prepared(request, domain, kSubdomains, static_cast<std::size_t>(threads)).plan;
  order.pslg = std::move(domain.pslg);
  order.sizing = request.sizing;
  order.limits = request.limits;
  order.use = {.in_subdomains = true};
  ThreadRun run(std::move(order), threads, nullptr, watch);
  run.refine();
  RunRecord record;
  run.report(record);
  return record;
}

std::uint64_t digest_by_threads(const Request& request, std::int32_t threads = 1) {
  Watch watch;
  return made_by_threads(request, threads, watch).digest;
}

std::uint64_t digest_simulated(Request request, std::int32_t ranks) {
  Watch watch;
  request.cluster.ranks = ranks;
  const Domain domain = read_domain(request, {}, watch);
  const Triangulated triangulated = triangulate_domain(request, domain, ranks, Cut::kAlways, watch);
  const Prepared ready =
      prepare(request, domain, triangulated, {}, kSimulated, speeds_of(cluster_of(request), {}), Limits{}, watch);
  RunRecord record;
  static_cast<void>(run_simulated(request, ready, Limits{}, {}, record, watch));
  return record.digest;
}

class Counting final : public Watch {
 public:
  void begins(const std::string& stage) override { begun.push_back(stage); }
  void ends(const std::string& stage, double seconds) override {
    ended.push_back(stage);
    CHECK(seconds >= 0);
  }
  std::vector<std::string> begun, ended;
};

}  // namespace

TEST_CASE("a prepared run has about the requested number of triangles") {
  CHECK(prepared(pipe(), kSubdomains, 1).forecast == doctest::Approx(2e4).epsilon(0.1));
  Request request = pipe();
  request.bounds.triangles = 0;
  request.bounds.triangles_per_rank = 2e4;
  CHECK(prepared(request, kRanks, 3).forecast == doctest::Approx(6e4).epsilon(0.1));
  request.decomposition.subdomains_per_rank = 7;
  CHECK(prepared(request, kRanks, 3).plan.decomposition.size() == 21);
  request.decomposition = {};
  request.decomposition.subdomains = 10;
  request.mapping.method = MappingMethod::kRoundRobin;
  const RunPlan plan = prepared(request, kRanks, 4).plan;
  for (const SubdomainId s : ids_of(plan.owners)) CHECK(to_int(plan.owners[s]) == to_int(s) % 4);
}

TEST_CASE("without a bound on size, the forecast is of triangles, in subdomains too") {
  Request request = bay();  // of 5e9 square meters
  request.decomposition.subdomains = 20;
  const Prepared ready = prepared(request, kSubdomains, 1);
  const auto in_one_piece = static_cast<double>(meshed(bay()).result.mesh.live_triangles());
  CHECK(ready.forecast == doctest::Approx(in_one_piece).epsilon(0.3));
  for (const Decomposition::Subdomain& s : ready.plan.decomposition.subdomains)
    CHECK(s.predicted == doctest::Approx(ready.forecast / 20).epsilon(0.6));
}

TEST_CASE("details of the input are refused before refinement, and only if the limit is too low for them") {
  Request request = bay();
  const auto triangles = static_cast<std::int64_t>(meshed(request).result.mesh.live_triangles());
  request.limits.max_triangles = triangles / 2;  // more than the initial triangulation has
  CHECK_THROWS_WITH_AS(static_cast<void>(meshed(request)), doctest::Contains("these bounds need about"), LimitError);
  CHECK_THROWS_AS(static_cast<void>(prepared(request, kSubdomains, 1, limits_of(request))), LimitError);
  request.limits.max_triangles = triangles + 100;
  CHECK(meshed(request).result.complete);
  CHECK_NOTHROW(static_cast<void>(prepared(request, kSubdomains, 1, limits_of(request))));
}

TEST_CASE("a mesh in one piece has about the requested number of triangles") {
  Counting watch;
  const Request request = pipe();
  const Domain domain = read_domain(request, {}, watch);
  const OnePiece made = meshed(request, domain, watch);
  CHECK(made.result.complete);
  CHECK(static_cast<double>(made.result.mesh.live_triangles()) == doctest::Approx(2e4).epsilon(0.15));
  CHECK(watch.begun == std::vector<std::string>{"read", "repair", "size", "triangulate", "refine"});
  CHECK(watch.ended == watch.begun);
}

TEST_CASE("the mesh in subdomains is the same here and on simulated ranks") {
  Request request = pipe();
  request.decomposition.subdomains = 12;
  const std::uint64_t digest = digest_by_threads(request);
  CHECK(digest_simulated(request, 1) == digest);
  CHECK(digest_simulated(request, 3) == digest);
  request.bounds.angle = 25;
  CHECK(digest_by_threads(request) != digest);
}

TEST_CASE("an order reaches the whole team, and so does an error") {
  testing::LoneTeam team;
  Request request = pipe();
  request.sizing.expression = "0.1 + x";
  Watch watch;
  Domain domain = read_domain(request, {}, watch);
  Order order;
  order.pslg = domain.pslg;
  order.sizing = request.sizing;
  order.limits.max_triangles = 77;
  order.shares = {0.5};
  order.use.writes = true;
  request.sizing = {};
  request.bounds.triangles = 1000;
  order.plan = prepared(request, kSubdomains, 1).plan;
  const std::optional<Order> shared = share(team, [&] { return std::optional(order); });
  REQUIRE(shared);
  CHECK(shared->pslg.points == order.pslg.points);
  CHECK(shared->sizing.expression == "0.1 + x");
  CHECK(shared->limits.max_triangles == 77);
  CHECK(shared->shares == order.shares);
  CHECK(shared->use.writes);
  CHECK(shared->plan.decomposition == order.plan.decomposition);
  CHECK_FALSE(share(team, [] { return std::optional<Order>(); }));
  CHECK_THROWS_AS(static_cast<void>(share(team, []() -> std::optional<Order> { throw LimitError("too much"); })),
                  LimitError);
}

TEST_CASE("limits hold wherever a mesh is made") {
  Request request = pipe();
  request.bounds.triangles = 1e6;
  Watch watch;
  const Domain domain = read_domain(request, {}, watch);
  Limits few;
  few.triangles = 1000;
  CHECK_THROWS_AS(static_cast<void>(prepared(request, domain, kRanks, 1, few)), LimitError);
  request.limits.max_triangles = 1000;
  CHECK_THROWS_AS(static_cast<void>(meshed(request, domain, watch)), LimitError);
  request.limits.keep_incomplete = true;
  CHECK_FALSE(meshed(request, domain, watch).result.complete);
}

TEST_CASE("data in the caller's memory replaces files") {
  Request request;
  request.bounds.area = 0.5;
  const Pslg input = generate("holes", {{"columns", "2"}, {"rows", "2"}});
  Given given;
  given.input = &input;
  Watch watch;
  const Domain domain = read_domain(request, given, watch);
  CHECK(domain.pslg.points.size() == input.points.size());
  CHECK(input_name(request) == "input");
}
