#include <doctest/doctest.h>

#include <cstdint>
#include <cstdio>
#include <map>
#include <memory>
#include <optional>
#include <random>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "balancer/policies/policy_factory.hpp"
#include "decompose/decompose.hpp"
#include "distributed/assembly.hpp"
#include "distributed/held_subdomains.hpp"
#include "driftmesh/error.hpp"
#include "mesh/cdt.hpp"
#include "mesh/corners.hpp"
#include "mesh/digest.hpp"
#include "oracles/random_pslg.hpp"
#include "property/cases.hpp"
#include "protocol/rank_step.hpp"
#include "protocol/threads/thread_network.hpp"
#include "runtime/plan_run.hpp"
#include "runtime/subdomain_loop.hpp"
#include "runtime/threads/refinement_in_rounds.hpp"
#include "runtime/threads/thread_crew.hpp"
#include "sizing/make_size_field.hpp"
#include "support/refine_together.hpp"
#include "verify/report_text.hpp"
#include "verify/verify.hpp"

// Random domains refined by threads that take subdomains from each other as often as they can: the mesh is that of a
// second implementation which knows no threads, whatever their number.

using namespace driftmesh;
using namespace driftmesh::testing;

namespace {

struct Outcome {
  std::uint64_t digest = 0;
  std::int64_t triangles = 0, moves = 0, splits = 0, asleep = 0;
  int rounds = 0;
};

PlanOptions options_for(std::int32_t threads, std::int64_t slice, Presplit presplit) {
  PlanOptions options;
  options.mapping.ranks = threads;
  options.mapping.method = MappingMethod::kBlock;
  options.presplit = presplit;
  options.work.slice = slice;
  options.balancing.policy = threads > 1 ? "stealing" : "none";
  options.balancing.options.look = 1e-6;
  options.balancing.options.gap = 0;
  options.balancing.options.worth.gain = 0;
  return options;
}

class Case {
 public:
  explicit Case(std::mt19937_64& random) {
    const std::uint64_t seed = random();
    oracles::RandomPslgShape shape = oracles::make_random_shape(seed);
    shape.scale = 1;
    shape.offset = 0;
    input_ = oracles::make_random_pslg(seed, shape).input;
    Triangulation mesh = triangulate(input_);
    prepare_corners(mesh);
    bounds_.min_angle = std::uniform_real_distribution(15.0, 28.0)(random);
    if (random() % 2 == 0) bounds_.plain.area = 0.02;
    if (random() % 3 == 0) expression_ = "0.05 + 0.2*abs(x)";
    if (!expression_.empty())
      size_ = make_size_field(
          {.expression = expression_, .gradation = 0.15, .spacing = 0.001, .domain = Box::of(input_.points)});
    bounds_.size = size_.get();
    DecomposeOptions cutting;
    cutting.subdomains = static_cast<std::int32_t>(2 + random() % 11);
    cutting.bounds = bounds_;
    try {
      decomposition_ = decompose(mesh, cutting);
    } catch (const Error&) {  // more than the domain allows
      cutting.subdomains = 1;
      decomposition_ = decompose(mesh, cutting);
    }
    slice_ = static_cast<std::int64_t>(1 + random() % 50);
  }

  /// By refine_together, without presplit interfaces.
  [[nodiscard]] std::uint64_t digest_without_threads() const {
    std::uint64_t digest = 0;
    for (const SubdomainMesh& part : refine_together(decomposition_, bounds_).parts) digest += mesh_digest(part.mesh);
    return digest;
  }

  [[nodiscard]] Outcome by_threads(std::int32_t threads, Presplit presplit, const RefinementInRounds::Watch& watch = {},
                                   bool sleep = false) const {
    PlanOptions options = options_for(threads, slice_, presplit);
    options.work.sleep = sleep;
    const RunPlan plan = plan_run(decomposition_, bounds_, options, balancer::make_policy);
    const std::vector<const SizeField*> sizes(static_cast<std::size_t>(threads), bounds_.size);
    RefinementInRounds refinement(plan, sizes, watch);
    refinement.run();
    check_mesh(refinement.subdomains(), presplit);
    Outcome outcome;
    outcome.rounds = refinement.rounds();
    for (const auto& [id, subdomain] : refinement.subdomains()) {
      outcome.asleep += subdomain.dormant();
      outcome.digest += mesh_digest(subdomain.dormant() ? subdomain.woken().mesh : subdomain.mesh().mesh);
    }
    for (const RankOutcome& thread : refinement.outcomes()) {
      outcome.moves += thread.counters.hand_offs;
      outcome.triangles += thread.triangles;
      outcome.splits += thread.interface_splits;
    }
    return outcome;
  }

  /// By ranks that have crews, as real ones do, but in this process.
  [[nodiscard]] Outcome by_crews(std::int32_t ranks, std::size_t crew, Presplit presplit) const {
    const RunPlan plan = plan_run(decomposition_, bounds_, options_for(ranks, slice_, presplit), balancer::make_policy);
    protocol::ThreadNetwork network(ranks);
    IdVector<Rank, CrewedRank> crewed(to_index(ranks));
    for (const Rank r : ids_of(crewed)) {
      crewed[r].plan = plan;
      crewed[r].crew.emplace(crew);
      crewed[r].loop.emplace(network.transport(r), crewed[r].plan);
      crewed[r].loop->hire(*crewed[r].crew);
    }
    std::vector<std::thread> threads;
    for (const Rank r : ids_of(crewed))
      threads.emplace_back(
          [&, r] { protocol::run_rank(network.transport(r), [&, r] { return crewed[r].loop->step(); }); });
    for (std::thread& thread : threads) thread.join();
    std::map<SubdomainId, Subdomain> all;
    for (CrewedRank& rank : crewed) all.merge(rank.loop->take_subdomains());
    check_mesh(all, presplit);
    Outcome outcome;
    for (const auto& [id, subdomain] : all) outcome.digest += mesh_digest(subdomain.mesh().mesh);
    return outcome;
  }

 private:
  struct CrewedRank {
    RunPlan plan;
    std::optional<ThreadCrew> crew;
    std::optional<SubdomainLoop> loop;
  };

  void check_mesh(const std::map<SubdomainId, Subdomain>& subdomains, Presplit presplit) const {
    PieceAssembly assembly(Rank{0}, 1, decomposition_, held_by_rank(subdomains));
    exchange_directly(IdVector<Rank, Exchange*>{&assembly});  // throws unless both sides of each root conform
    VerifyOptions options;
    options.min_angle = bounds_.min_angle;
    options.plain.area = bounds_.plain.area;
    options.plain.region_areas = false;
    options.size = bounds_.size;
    options.size_is_compiled = true;
    const VerifyReport report = verify(assembly.piece(input_).mesh, input_, options);
    CAPTURE(presplit);
    CHECK_MESSAGE(report.accepted(), report_text(report, options));
  }

  Pslg input_;
  QualityBounds bounds_;
  std::string expression_;
  std::unique_ptr<SizeField> size_;
  Decomposition decomposition_;
  std::int64_t slice_ = 1;
};

}  // namespace

TEST_CASE("any number of threads makes the mesh that one makes, also of subdomains that sleep") {
  std::mt19937_64 random = seeded_generator("threads");
  std::int64_t moves = 0, later_rounds = 0, triangles = 0, asleep = 0;
  for (std::int64_t i = 0; more_cases(i, 150, moves > 50 && later_rounds > 10); ++i) {
    const Case c(random);
    const std::uint64_t expected = c.digest_without_threads();
    const Outcome presplit = c.by_threads(1, Presplit::kAuto);
    for (const std::int32_t threads : {1, 2, 3, 5}) {
      CAPTURE(threads);
      const Outcome made = c.by_threads(threads, Presplit::kOff);
      CHECK(made.digest == expected);
      CHECK(c.by_threads(threads, Presplit::kAuto).digest == presplit.digest);
      if (threads > 2) continue;
      const Outcome slept = c.by_threads(threads, Presplit::kOff, {}, true);
      CHECK(slept.digest == expected);
      asleep += slept.asleep;
      moves += made.moves;
      later_rounds += made.rounds - 1;
      triangles += made.triangles;
    }
  }
  std::printf("%lld triangles, %lld moves, %lld later rounds\n", static_cast<long long>(triangles),
              static_cast<long long>(moves), static_cast<long long>(later_rounds));
  CHECK(moves > 50);
  CHECK(later_rounds > 10);
  CHECK(asleep > 100);
}

TEST_CASE("crews help their ranks, and where no interface is split by refinement the mesh does not tell") {
  std::mt19937_64 random = seeded_generator("crews");
  std::int64_t compared = 0;
  for (std::int64_t i = 0; more_cases(i, 100, compared > 3); ++i) {
    const Case c(random);
    const Outcome alone = c.by_threads(1, Presplit::kAuto);
    compared += alone.splits == 0;
    for (const std::int32_t ranks : {1, 2})
      for (const std::size_t crew : {1, 3}) {
        CAPTURE(ranks);
        CAPTURE(crew);
        const Outcome made = c.by_crews(ranks, crew, Presplit::kAuto);
        if (alone.splits == 0) CHECK(made.digest == alone.digest);
        static_cast<void>(c.by_crews(ranks, crew, Presplit::kOff));  // checks the mesh
      }
  }
  CHECK(compared > 3);
}

TEST_CASE("what one thread throws ends the work of all") {
  std::mt19937_64 random = seeded_generator("threads");
  for (int i = 0; i < 20; ++i) {
    const Case c(random);
    const std::int64_t enough = c.by_threads(3, Presplit::kOff).triangles / 2;
    const auto error_with = [&](const RefinementInRounds::Watch& watch) -> std::string {
      try {
        static_cast<void>(c.by_threads(3, Presplit::kOff, watch));
      } catch (const std::runtime_error& error) {
        return error.what();
      }
      return "nothing";
    };
    CHECK(error_with({.check = [=](std::int64_t made) {
            if (made >= enough) throw std::runtime_error("full");
          }}) == "full");
    CHECK(error_with({.progress = [](std::int64_t made) {
            if (made > 0) throw std::runtime_error("cancelled");
          }}) == "cancelled");
  }
}

TEST_CASE("progress is that of all threads") {
  std::mt19937_64 random = seeded_generator("threads");
  const Case c(random);
  std::int64_t last = 0;
  const Outcome made = c.by_threads(3, Presplit::kOff, {.progress = [&](std::int64_t triangles) { last = triangles; }});
  CHECK(last > 0);
  CHECK(last <= made.triangles);
}
