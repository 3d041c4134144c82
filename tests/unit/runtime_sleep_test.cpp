#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <vector>

#include "runtime_fixture.hpp"
#include "support/adversarial_network.hpp"

using namespace driftmesh;
using namespace driftmesh::testing;

TEST_CASE("subdomains sleep where the plan of their run says") {
  RunPlan plan = plan_of(ell(), {20, {1e-3}, {}, nullptr}, 1, 4, Presplit::kOff);
  CHECK_FALSE(context_of(plan).sleep);
  CHECK(context_of(plan).scratch == nullptr);
  ScratchFile disk(std::filesystem::temp_directory_path().string());
  plan.work.sleep = true;
  plan.scratch = &disk;
  CHECK(context_of(plan).sleep);
  CHECK(context_of(plan).scratch == &disk);
}

TEST_CASE("sleeping subdomains wake up when a new point arrives") {
  std::int64_t asleep = 0, split = 0;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    RunPlan plan = plan_of(ell(), {20, {1e-3}, {}, nullptr}, 3, 20, Presplit::kOff);
    plan.work.sleep = true;
    protocol::AdversarialNetwork network(3, protocol::Adversary::from_seed(seed));
    SimulatedRanks run(network, 3, plan);
    REQUIRE(network.run(run.steps).end == protocol::RunEnd::kFinished);
    for (const auto& loop : run.loops) {
      split += loop->interface_splits();
      for (const auto& [id, subdomain] : loop->subdomains()) {
        asleep += subdomain.dormant();
        const_cast<Subdomain&>(subdomain).wake();
      }
    }
    check_mesh(plan, run.subdomains());
  }
  CHECK(asleep == 6 * 20);
  CHECK(split > 100);
}

TEST_CASE("subdomains that sleep when finished make one conforming mesh, in memory or on disk, and can move asleep") {
  enum class Bed { kNone, kMemory, kDisk };
  ScratchFile disk(std::filesystem::temp_directory_path().string());
  int asleep = 0, moved = 0;
  for (const Presplit presplit : {Presplit::kOn, Presplit::kOff})
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
      CAPTURE(seed);
      RunPlan plan = plan_of(ell(), {20, {1e-3}, {}, nullptr}, 3, 20, presplit);
      const SubdomainContext context{&plan.decomposition, plan.bounds, plan.presplit};
      std::uint64_t digest = 0, asleep_in_memory = 0;
      for (const Bed bed : {Bed::kNone, Bed::kMemory, Bed::kDisk}) {
        const bool sleep = bed != Bed::kNone;
        plan.work.sleep = sleep;
        plan.scratch = bed == Bed::kDisk ? &disk : nullptr;
        protocol::AdversarialNetwork network(3, protocol::Adversary::from_seed(seed));
        SimulatedRanks run(network, 3, plan);
        const auto move_sleeper = [&](Rank r) {
          auto& loop = *run.loops[r];
          const auto sleeper = std::find_if(loop.subdomains().begin(), loop.subdomains().end(),
                                            [](const auto& s) { return s.second.dormant(); });
          if (sleeper == loop.subdomains().end() || seed % 2 == 0) return;
          loop.hand_over(sleeper->first, next_in_ring(r, 3));
          ++moved;
        };
        REQUIRE(network.run(run.steps, move_sleeper).end == protocol::RunEnd::kFinished);
        std::vector<Subdomain> awake;
        for (const Subdomain* s : run.subdomains()) {
          asleep += s->dormant();
          CHECK(s->dormant() == sleep);
          awake.push_back(Subdomain::unpack(s->pack(), context));
          awake.back().wake();
        }
        std::vector<const Subdomain*> all;
        for (const Subdomain& s : awake) all.push_back(&s);
        check_mesh(plan, all);
        const bool moves = seed % 2 != 0;  // sleepers alone, so that what arrives when depends on who sleeps
        if (!sleep) digest = digest_of(all);
        if (presplit == Presplit::kOn || !moves) CHECK(digest_of(all) == digest);
        if (bed == Bed::kMemory) asleep_in_memory = digest_of(all);
        if (bed == Bed::kDisk) CHECK(digest_of(all) == asleep_in_memory);
      }
    }
  CHECK(asleep == 2 * 2 * 8 * 20);
  CHECK(moved > 50);
}
