// Real ranks that plan together: Zoltan on their communicator.
#include <doctest/doctest.h>

#include "balancer/mpi/mpi_council.hpp"
#include "balancer/policies/policy_factory.hpp"
#include "base/bytes.hpp"
#include "support/joint_rounds.hpp"

using namespace driftmesh;
using namespace driftmesh::balancer;
using namespace driftmesh::testing;

namespace {

Bytes to_bytes(const Council::Decision& decision) {
  ByteWriter writer;
  writer.array(decision.moves);
  writer.array(decision.states);
  writer.value(decision.coming);
  writer.value(decision.any_moves);
  return writer.take();
}

Council::Decision from_bytes(const Bytes& bytes) {
  Council::Decision decision;
  ByteReader reader(bytes);
  reader.array(decision.moves);
  reader.array(decision.states);
  reader.value(decision.coming);
  reader.value(decision.any_moves);
  return decision;
}

/// What all ranks decided, on each.
std::vector<Council::Decision> hold_round(protocol::MpiTransport& transport, const Parameters::Values& parameters,
                                          const LoadSnapshot& snapshot,
                                          const std::vector<Contribution>& contributions) {
  const std::shared_ptr<const Policy> policy = make_policy("zoltan", parameters);
  MpiCouncil council(transport, snapshot.layout, policy, {});
  const Contribution& own = contributions[to_index(transport.rank())];
  std::vector<Council::Decision> decisions;
  for (const Bytes& bytes : transport.all_gather(to_bytes(council.decide(1, own).value())))
    decisions.push_back(from_bytes(bytes));
  return decisions;
}

Parameters::Values collective(const std::string& method, const std::string& approach, const char* touch_up = "0.1") {
  return {{"placement", "collective"}, {"method", method}, {"approach", approach}, {"touch-up", touch_up}};
}

}  // namespace

TEST_CASE("joint plans on real ranks end balanced, and all ranks agree on the result") {
  protocol::MpiTransport transport(protocol::MpiSession::world());
  IdVector<Rank, double> speeds{1e5, 2e5, 3e5, 1e5};
  speeds.resize(to_index(transport.ranks()));
  check_balanced(
      grid_layout(30, 30, transport.ranks()), speeds,
      [&](const std::string& method, const std::string& approach, const auto& snapshot, const auto& contributions) {
        return hold_round(transport, collective(method, approach), snapshot, contributions);
      });
  transport.close();
}

TEST_CASE("random loads, finished neighbors, ranks without any") {
  protocol::MpiTransport transport(protocol::MpiSession::world());
  int moved = 0;
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    Layout layout =
        grid_layout(1 + static_cast<int>(random() % 12), 1 + static_cast<int>(random() % 12), transport.ranks());
    IdVector<Rank, double> speeds;
    while (speeds.size() < to_index(transport.ranks())) speeds.push_back(static_cast<double>(random() % 4) * 1e4);
    for (auto& s : layout.subdomains) {
      const std::uint64_t kind = random() % 4;
      s.predicted = kind == 0 ? 0 : kind == 1 ? 1e-3 : static_cast<double>(random() % 5000);
      if (random() % 2 == 0) s.owner = static_cast<Rank>(random() % static_cast<std::uint64_t>(transport.ranks()));
    }
    LoadSnapshot snapshot = initial_snapshot(std::move(layout), speeds);
    const std::uint64_t kept = random() % 5;
    std::erase_if(snapshot.subdomains, [&](const auto&) { return random() % 4 >= kept; });
    sum_up(snapshot);
    const auto contributions = contributions_of(snapshot, &random);
    const std::string method = std::vector<std::string>{"rcb", "hsfc", "graph", "hypergraph"}[random() % 4];
    const char* const touch_up = random() % 2 == 0 ? "0" : "0.1";
    const auto decisions = hold_round(transport, collective(method, "repartition", touch_up), snapshot, contributions);
    REQUIRE(problem_of(snapshot, contributions, decisions) == "");
    if (decisions[0].any_moves) REQUIRE(time_with(snapshot, all_moves(decisions)) < time_with(snapshot, {}));
    moved += decisions[0].any_moves;
  }
  if (transport.ranks() > 1) CHECK(moved > 20);
  transport.close();
}

TEST_CASE("only collective policies need a council") {
  protocol::MpiTransport transport(protocol::MpiSession::world());
  const auto layout = std::make_shared<const Layout>(grid_layout(2, 2, transport.ranks()));
  CHECK(make_mpi_council(transport, layout, nullptr, {}) == nullptr);
  CHECK(make_mpi_council(transport, layout, make_policy("zoltan"), {}) == nullptr);
  CHECK(make_mpi_council(transport, layout, make_policy("zoltan", {{"placement", "collective"}}), {}) != nullptr);
  transport.close();
}
