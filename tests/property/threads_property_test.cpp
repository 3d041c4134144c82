#include <doctest/doctest.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <map>
#include <memory>
#include <mutex>
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
#include "distributed/ranks.hpp"
#include "driftmesh/error.hpp"
#include "mesh/cdt.hpp"
#include "mesh/corners.hpp"
#include "mesh/digest.hpp"
#include "property/cases.hpp"
#include "protocol/rank_step.hpp"
#include "protocol/threads/thread_network.hpp"
#include "runtime/plan_run.hpp"
#include "runtime/subdomain_loop.hpp"
#include "runtime/threads/refinement_in_rounds.hpp"
#include "runtime/threads/thread_crew.hpp"
#include "sizing/make_size_field.hpp"
#include "support/random_domain.hpp"
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
  int rounds = 0, stops = 0;
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
    input_ = random_domain(random());
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
    std::int64_t arrivals = 0, bytes = 0, messages = 0;
    for (const RankOutcome& thread : refinement.outcomes()) {
      outcome.moves += thread.counters.hand_offs;
      outcome.triangles += thread.triangles;
      outcome.splits += thread.interface_splits;
      arrivals += thread.counters.arrivals;
      bytes += thread.counters.hand_off_bytes;
      messages += thread.messages;
    }
    CHECK(arrivals == outcome.moves);
    CHECK(bytes >= outcome.moves);
    CHECK(messages >= outcome.moves);
    CHECK((outcome.splits > 0) == (outcome.rounds > 1));  // a later round follows up on points of those before
    return outcome;
  }

  /// By one to three processes, which are threads here, with one to three threads each, stopped at random fences;
  /// others go on each time with what was packed there.
  [[nodiscard]] Outcome by_some_after_others(std::mt19937_64& random, Presplit presplit, bool sleep) const {
    Kept kept;
    Outcome outcome;
    for (bool done = false; !done; ++outcome.stops)
      done = by_processes(static_cast<std::int32_t>(1 + random() % 3), static_cast<std::int32_t>(1 + random() % 3),
                          random() % 4, random(), presplit, sleep, kept, outcome);
    --outcome.stops;
    return outcome;
  }

  void check_refusals() const {
    const RunPlan plan = plan_run(decomposition_, bounds_, options_for(1, slice_, Presplit::kOff));
    const std::vector<const SizeField*> sizes{bounds_.size};
    Bytes kept;
    RefinementInRounds* refinement = nullptr;
    RefinementInRounds made(plan, sizes,
                            {.halts = [] { return true; },
                             .fence =
                                 [&](bool rests) {
                                   kept = refinement->halted(SubdomainId{0});
                                   return rests;
                                 }});
    refinement = &made;
    made.run();
    REQUIRE(!kept.empty());
    RefinementInRounds other(plan, sizes, {});
    CHECK_NOTHROW(other.take_up(SubdomainId{0}, kept));
    CHECK_THROWS_AS(other.take_up(SubdomainId{1}, kept), Error);
    kept[kept.size() / 2] ^= std::byte{1};
    CHECK_THROWS_AS(other.take_up(SubdomainId{0}, kept), Error);
    kept.resize(kept.size() / 2);
    CHECK_THROWS_AS(other.take_up(SubdomainId{0}, kept), Error);
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
  using Kept = std::map<SubdomainId, Bytes>;
  struct Stopped : std::exception {};

  /// Goes on with what was kept up to fence `last`, if refinement does not end before. Returns whether it did.
  [[nodiscard]] bool by_processes(std::int32_t processes, std::int32_t threads, std::uint64_t last, std::uint64_t seed,
                                  Presplit presplit, bool sleep, Kept& kept, Outcome& outcome) const {
    const Kept before = std::exchange(kept, {});
    PlanOptions options = options_for(threads, slice_, presplit);
    options.work.sleep = sleep;
    const RunPlan plan = plan_run(decomposition_, bounds_, options, balancer::make_policy);
    std::mt19937_64 random(seed);
    IdVector<SubdomainId, Rank> holders;
    for (std::size_t i = 0; i < decomposition_.size(); ++i)
      holders.push_back(static_cast<Rank>(random() % static_cast<std::uint64_t>(processes)));
    protocol::ThreadNetwork network(processes);
    std::mutex alone;
    std::map<SubdomainId, Subdomain> all;
    IdVector<Rank, RunPlan> plans(to_index(processes), plan);
    IdVector<Rank, std::unique_ptr<RefinementInRounds>> refinements(to_index(processes));
    std::atomic<int> stopped = 0;
    const auto work_on = [&](Rank r) {
      RanksOfTransport ranks(network.transport(r));
      deal_to_threads(plans[r], threads, [&](SubdomainId s) { return holders[s] == r; });
      std::mt19937_64 own(seed + static_cast<std::uint64_t>(to_int(r)));
      std::atomic<int> steps = static_cast<int>(own() % 30);
      std::uint64_t fences = 0;
      RefinementInRounds::Watch watch;
      watch.halts = [&] { return --steps <= 0; };
      watch.fence = [&](bool rests) {
        steps = static_cast<int>(own() % 30);
        ByteWriter letter;
        letter.value(static_cast<std::uint8_t>(rests ? 1 : 0));
        bool over = true;
        for (const Bytes& from : ranks.bytes_of_all(letter.take()))
          over = over && ByteReader(from).value<std::uint8_t>() == 1;
        if (fences++ < last) return over;
        const std::lock_guard lock(alone);
        for (const SubdomainId s : refinements[r]->here()) kept[s] = refinements[r]->halted(s);
        throw Stopped();
      };
      const std::vector<const SizeField*> sizes(static_cast<std::size_t>(threads), bounds_.size);
      refinements[r] = std::make_unique<RefinementInRounds>(plans[r], sizes, watch, HeldOnRanks{ranks, holders});
      for (const auto& [s, bytes] : before)
        if (holders[s] == r) refinements[r]->take_up(s, bytes);
      try {
        refinements[r]->run();
        outcome.rounds = std::max(outcome.rounds, refinements[r]->rounds());
      } catch (const Stopped&) {
        ++stopped;
      }
    };
    std::vector<std::thread> others;
    for (const Rank r : first_ids<Rank>(processes)) others.emplace_back([&, r] { work_on(r); });
    for (std::thread& other : others) other.join();
    if (stopped > 0) {
      CHECK(stopped == processes);
      CHECK(kept.size() == decomposition_.size());
      return false;
    }
    for (const auto& refinement : refinements) all.merge(refinement->subdomains());
    check_mesh(all, presplit);
    for (const auto& [id, subdomain] : all)
      outcome.digest += mesh_digest(subdomain.dormant() ? subdomain.woken().mesh : subdomain.mesh().mesh);
    return true;
  }

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

TEST_CASE("a run that is stopped at fences and gone on with by others makes the same mesh") {
  std::mt19937_64 random = seeded_generator("fences");
  std::int64_t stops = 0, later_rounds = 0;
  for (std::int64_t i = 0; more_cases(i, 60, stops > 100 && later_rounds > 10); ++i) {
    CAPTURE(i);
    const Case c(random);
    const Outcome whole = c.by_threads(1, Presplit::kOff);
    const bool sleep = i % 3 == 0;
    const Outcome made = c.by_some_after_others(random, Presplit::kOff, sleep);
    CHECK(made.digest == whole.digest);
    CHECK(made.rounds == whole.rounds);
    stops += made.stops;
    later_rounds += whole.rounds - 1;
    if (i % 4 == 0)
      CHECK(c.by_some_after_others(random, Presplit::kAuto, sleep).digest == c.by_threads(1, Presplit::kAuto).digest);
  }
  std::printf("%lld stops, %lld later rounds\n", static_cast<long long>(stops), static_cast<long long>(later_rounds));
  CHECK(stops > 100);
  CHECK(later_rounds > 10);
}

TEST_CASE("what was kept of another plan, or is damaged, is refused") {
  std::mt19937_64 random = seeded_generator("fences");
  const Case c(random);
  c.check_refusals();
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
  std::int64_t last = -1;
  int repeated = 0;
  const Outcome made = c.by_threads(3, Presplit::kOff, {.progress = [&](std::int64_t triangles) {
                                      repeated += triangles == last;
                                      last = triangles;
                                    }});
  CHECK(last > 0);
  CHECK(repeated < made.rounds);  // nothing is said twice in a round
  CHECK(last <= made.triangles);
}
