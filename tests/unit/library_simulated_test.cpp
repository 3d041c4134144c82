#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "api/library_request.hpp"
#include "api/simulated/cluster_request.hpp"
#include "driftmesh/error.hpp"
#include "driftmesh/generate.hpp"
#include "driftmesh/policy.hpp"
#include "driftmesh/simulated.hpp"

// The library's runs on simulated clusters.

using namespace driftmesh;

namespace {

const Pslg& plate_with_hole() {
  static const Pslg input = generate_rectangle_hole({});
  return input;
}

MeshOptions eager(const std::string& policy) {
  return {.triangles = 30'000, .subdomains = {.count = 40}, .balance = {.policy = policy, .look = 1e-3, .gap = 1e-3}};
}

const SimulatedCluster kUneven{.rank_speeds = {1e5, 1e5, 4e5}};

std::string error_of(const MeshOptions& options, const SimulatedCluster& cluster) {
  try {
    static_cast<void>(simulate(plate_with_hole(), options, cluster));
  } catch (const Error& error) {
    return error.what();
  }
  return "nothing";
}

}  // namespace

TEST_CASE("a simulated run is the same again, and shorter with a policy") {
  const SimulatedRun none = simulate(plate_with_hole(), eager("none"), kUneven);
  CHECK(none.moves.empty());
  CHECK(none.owners_before == none.owners_after);
  CHECK(none.owners_after.size() == 40);
  CHECK(none.speeds == kUneven.rank_speeds);
  CHECK(none.ranks.size() == 3);
  CHECK(none.ideal_seconds < none.seconds);
  CHECK(none.message_bytes > none.messages);
  const SimulatedRun greedy = simulate(plate_with_hole(), eager("greedy"), kUneven);
  CHECK_FALSE(greedy.moves.empty());
  CHECK(greedy.triangles == none.triangles);
  CHECK(greedy.seconds < none.seconds);
  CHECK(greedy.seconds == simulate(plate_with_hole(), eager("greedy"), kUneven).seconds);
}

TEST_CASE("a policy of the caller moves subdomains of a simulated run") {
  MeshOptions options = eager("none");
  options.balance.own = balancer::leader_policy([](const balancer::LoadSnapshot& load) {
    std::vector<balancer::Move> moves;
    for (const balancer::SubdomainLoad& s : load.subdomains)
      if (!s.fixed && s.owner != Rank{2} && s.turn > 0) moves.push_back({s.id, Rank{2}});
    return moves;
  });
  const SimulatedRun run = simulate(plate_with_hole(), options, kUneven);
  REQUIRE_FALSE(run.moves.empty());
  CHECK(run.moves.front().from != Rank{2});
  CHECK(run.moves.front().to == Rank{2});
  CHECK(run.moves.front().left < run.moves.front().arrived);
}

TEST_CASE("errors of simulated runs") {
  CHECK(error_of({}, {}).find("SimulatedCluster::ranks is 0") == 0);
  CHECK(error_of({}, {.ranks = 2, .latency = -1}).find("SimulatedCluster::latency is -1") == 0);
  CHECK(error_of(eager("grab"), kUneven).find("MeshOptions::balance.policy") != std::string::npos);
}

TEST_CASE("a cluster has the defaults and the names of its keys") {
  job::Request request;
  visit_cluster(SimulatedCluster{}, request,
                [](const char* key, const char* member, const auto& value, const auto& place) {
                  CAPTURE(std::string(key));
                  CHECK(library_name(key).member == member);
                  CHECK(words_of_library(key) == std::string("SimulatedCluster::") + member);
                  CHECK(value == place);
                });
}
