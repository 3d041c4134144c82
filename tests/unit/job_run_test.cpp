#include <doctest/doctest.h>

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "balancer/policies/policy_factory.hpp"
#include "driftmesh/error.hpp"
#include "job/check.hpp"
#include "job/domain.hpp"
#include "job/here.hpp"
#include "job/make.hpp"
#include "job/order.hpp"
#include "job/record.hpp"
#include "job/simulated/simulated_ranks.hpp"
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

const Given kPolicies{.policies = balancer::make_policy};

struct Made {
  RunRecord record;
  std::unique_ptr<Refined> refined;

  [[nodiscard]] const RunPlan& plan() const { return *refined->plan(); }
};

Made made_at(Place& place, const Request& request, Watch& watch, const Given& given = kPolicies) {
  Made made;
  made.refined = make({request, kMesh, given, {.mesh = true, .whole = true}}, place, made.record, watch);
  made.refined->report(made.record);
  return made;
}

Made made_at(Place&& place, const Request& request) {
  Watch watch;
  return made_at(place, request, watch);
}

Made in_one_piece(Request request) {
  request.decomposition.subdomains = 1;
  return made_at(Here(kOnePiece, 1), request);
}

Made by_threads(const Request& request, std::int32_t threads = 1) {
  return made_at(Here(job::kSubdomains, threads), request);
}

Made simulated(Request request, std::int32_t ranks) {
  request.cluster.ranks = ranks;
  return made_at(SimulatedRanks(cluster_of(request)), request);
}

class Counting final : public Watch {
 public:
  void begins(const std::string& stage) override { begun.push_back(stage); }
  std::vector<std::string> begun;
};

/// Two ranks that refine one domain without cutting it. They keep what they are told, and make nothing.
class Uncut final : public Place {
 public:
  [[nodiscard]] PlaceKind kind() const override { return kRanks; }
  [[nodiscard]] std::int32_t ranks() const override { return 2; }
  [[nodiscard]] Cut cut(const Request& /*request*/) const override { return Cut::kNever; }
  [[nodiscard]] IdVector<Rank, double> speeds(const Request& request) const override {
    return shares_of_time(request, ranks());
  }
  [[nodiscard]] std::unique_ptr<Refined> refine(Order&& order, const Limits& /*limits*/, const SizeField* /*size*/,
                                                Watch& /*watch*/) override {
    told = std::move(order);
    return nullptr;
  }
  Order told;
};

}  // namespace

TEST_CASE("ranks that share an uncut domain are told its input, bounds, and their shares of time") {
  Request request = pipe();
  request.run.method = Method::kPdr;
  request.cluster.kind = ClusterKind::kReal;
  request.cluster.drag = {1, 0.5};
  Uncut place;
  Watch watch;
  RunRecord record;
  static_cast<void>(make({request, kExperiment, kPolicies}, place, record, watch));
  CHECK(place.told.shares == IdVector<Rank, double>{1, 0.5});
  CHECK(place.told.plan.bounds.plain.area == record.max_area);
  CHECK(record.max_area > 0);
  CHECK(record.forecast == doctest::Approx(2e4).epsilon(0.1));
  CHECK(static_cast<std::int64_t>(place.told.pslg.points.size()) == record.input_points);
  CHECK(!place.told.whole);
}

TEST_CASE("a mesh in subdomains has about the requested number of triangles") {
  CHECK(by_threads(pipe()).record.forecast == doctest::Approx(2e4).epsilon(0.1));
  Request request = pipe();
  request.bounds.triangles = 0;
  request.bounds.triangles_per_rank = 2e4;
  CHECK(simulated(request, 3).record.forecast == doctest::Approx(6e4).epsilon(0.1));
  request.decomposition.subdomains_per_rank = 7;
  CHECK(simulated(request, 3).plan().decomposition.size() == 21);
  request.decomposition = {};
  request.decomposition.subdomains = 10;
  request.mapping.method = MappingMethod::kRoundRobin;
  const Made made = simulated(request, 4);
  for (const SubdomainId s : ids_of(made.plan().owners)) CHECK(to_int(made.plan().owners[s]) == to_int(s) % 4);
}

TEST_CASE("without a bound on size, the forecast is of triangles, in subdomains too") {
  Request request = bay();  // 5e9 square meters
  const auto whole = static_cast<double>(in_one_piece(request).record.triangles);
  request.decomposition.subdomains = 20;
  const Made made = by_threads(request);
  CHECK(made.record.forecast == doctest::Approx(whole).epsilon(0.3));
  for (const Decomposition::Subdomain& s : made.plan().decomposition.subdomains)
    CHECK(s.predicted == doctest::Approx(made.record.forecast / 20).epsilon(0.6));
}

TEST_CASE("details of the input are refused before refinement, and only if the limit is too low for them") {
  Request request = bay();
  const std::int64_t triangles = in_one_piece(request).record.triangles;
  request.limits.max_triangles = triangles / 2;  // more than the initial triangulation has
  CHECK_THROWS_WITH_AS(in_one_piece(request), doctest::Contains("these bounds need about"), LimitError);
  CHECK_THROWS_WITH_AS(by_threads(request), doctest::Contains("these bounds need about"), LimitError);
  request.limits.max_triangles = triangles + 100;
  CHECK(in_one_piece(request).record.complete);
  request.limits.max_triangles = 2 * triangles;
  CHECK_NOTHROW(by_threads(request));
}

TEST_CASE("a mesh in one piece has about the requested number of triangles") {
  Counting watch;
  Here here(kOnePiece, 1);
  const Made made = made_at(here, pipe(), watch);
  CHECK(made.record.complete);
  CHECK(made.refined->plan() == nullptr);
  CHECK(static_cast<double>(made.record.triangles) == doctest::Approx(2e4).epsilon(0.15));
  CHECK(watch.begun == std::vector<std::string>{"read", "repair", "size", "triangulate", "refine"});
  const std::vector<StageTime> ended = watch.take_stages();
  REQUIRE(ended.size() == watch.begun.size());
  for (std::size_t i = 0; i < ended.size(); ++i) {
    CHECK(ended[i].name == watch.begun[i]);
    CHECK(ended[i].seconds >= 0);
  }
}

TEST_CASE("the mesh in subdomains is the same here and on simulated ranks") {
  Request request = pipe();
  request.decomposition.subdomains = 12;
  const std::uint64_t digest = by_threads(request).record.digest;
  CHECK(by_threads(request, 3).record.digest == digest);
  CHECK(simulated(request, 1).record.digest == digest);
  CHECK(simulated(request, 3).record.digest == digest);
  request.bounds.angle = 25;
  CHECK(by_threads(request).record.digest != digest);
}

TEST_CASE("a simulated cluster keeps no mesh") {
  Watch watch;
  CHECK_THROWS_AS(static_cast<void>(simulated(pipe(), 2).refined->take_piece(watch)), Error);
}

TEST_CASE("an order reaches the whole team, and so does an error") {
  testing::LoneTeam team;
  const Request request = pipe();
  const Made made = by_threads(request);
  Order order;
  order.pslg = generate("pipe", {});
  order.sizing.expression = "0.1 + x";
  order.limits.max_triangles = 77;
  order.shares = {0.5};
  order.use.writes = true;
  order.plan = made.plan();
  const Pslg pslg = order.pslg;
  const Order shared = share(team, [&] { return std::move(order); });
  CHECK(shared.pslg.points == pslg.points);
  CHECK(shared.sizing.expression == "0.1 + x");
  CHECK(shared.limits.max_triangles == 77);
  CHECK(shared.shares == IdVector<Rank, double>{0.5});
  CHECK(shared.use.writes);
  CHECK(shared.plan.decomposition == made.plan().decomposition);
  CHECK_THROWS_AS(static_cast<void>(share(team, []() -> Order { throw LimitError("too much"); })), LimitError);
}

TEST_CASE("an incomplete mesh says why, if it may be kept") {
  Request request = pipe();
  request.bounds.triangles = 1e5;
  request.limits.max_triangles = 1000;
  request.limits.keep_incomplete = true;
  const Made made = in_one_piece(request);
  CHECK_FALSE(made.record.complete);
  CHECK(made.record.stopped_by == "limits.max-triangles");
  CHECK(made.refined->shortfall(true).in(full_name).starts_with("stopped at 1,0"));
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
