// Subdomains that move as often as possible while SPLITs are under way (presplit off), between real ranks of unequal
// speed, with messages late and out of order. DRIFTMESH_SEED=N repeats the choices of a seed, as far as real ranks are
// reproducible.
#include <doctest/doctest.h>

#include <cstdlib>
#include <string>

#include "driftmesh/generate.hpp"
#include "driftmesh/repair.hpp"
#include "mpi/handle_census.hpp"
#include "mpi/mesh_on_ranks.hpp"

using namespace driftmesh;
using namespace driftmesh::mpi_test;

namespace {

#if defined(__SANITIZE_ADDRESS__) || !defined(NDEBUG)
constexpr int kShrink = 6;
constexpr std::uint64_t kRuns = 2;
#else
constexpr int kShrink = 1;
constexpr std::uint64_t kRuns = 4;
#endif

std::uint64_t first_seed() {
  const char* wanted = std::getenv("DRIFTMESH_SEED");
  return wanted == nullptr ? 1 : std::strtoull(wanted, nullptr, 10);
}

Job holes(std::uint64_t seed) {
  Job job;
  job.input = generate_holes({.columns = 3, .rows = 2});
  repair(job.input);
  job.cells = 60000.0 / kShrink;
  job.subdomains = 60;
  job.slice = 10;
  job.seed = seed;
  job.delay = seed % 2 == 0 ? 60 : 5;
  job.drag = true;
  job.sleep = seed % 2 == 0;
  return job;
}

/// A policy that checks constantly, ignores costs, and accepts the smallest gain.
Balancing restless(const std::string& policy) {
  Balancing balancing;
  balancing.policy = policy;
  balancing.options.look = 0;
  balancing.options.gap = 2e-4;
  balancing.options.interval = 2e-3;
  balancing.options.change = 1e-3;
  balancing.options.overhead = 1;
  balancing.options.cost = {.latency = 0, .bandwidth = 1e15, .pack_work = 0};
  balancing.options.worth = {.gain = 0, .seconds = 0, .slack = 0};
  if (policy == "greedy") balancing.parameters = {{"tolerance", "0"}};
  if (policy == "stealing") balancing.parameters = {{"low-water", "0.002"}};
  if (policy == "zoltan")
    balancing.parameters = {{"method", "rcb"}, {"approach", "partition"}, {"touch-up", "0"}, {"tolerance", "0"}};
  return balancing;
}

/// Makes the run and checks everything; rank 0 prints a summary.
Outcome stress(const Job& job) {
  const HandleCensus before = handle_census();
  Outcome outcome = run(job);
  CHECK(handle_census() == before);
  check(job, outcome);
  const protocol::ProtocolCounters& c = outcome.counters;
  if (outcome.leads)
    MESSAGE("DRIFTMESH_SEED=", job.seed, " ", job.balancing.policy, ": ", c.hand_offs, " moves, ", outcome.forced,
            " of them forced, ", c.splits_sent, " SPLITs, ", c.forwarded, " groups forwarded, ", c.most_hops,
            " times at most, ", c.held, " held");
  return outcome;
}

void stress_policy(const std::string& policy) {
  std::int64_t forced = 0, planned = 0, forwarded = 0;
  bool leads = false;
  for (std::uint64_t seed = first_seed(), last = seed + kRuns; seed < last; ++seed) {
    CAPTURE(seed);
    Job job = holes(seed);
    job.balancing = restless(policy);
    job.moves = seed % 2 == 0 || policy == "none";
    if (!job.moves) job.cells *= 4, job.slice = 100;  // a speed is known after some hundredths of a second
    const Outcome outcome = stress(job);
    leads = outcome.leads;
    forced += outcome.forced;
    planned += outcome.counters.hand_offs - outcome.forced;
    forwarded += outcome.counters.forwarded;
  }
  if (!leads) return;
  CHECK(forced > 500 / kShrink);
  CHECK((planned > 0) == (policy != "none"));
  CHECK(forwarded > 0);
}

}  // namespace

TEST_CASE("thousands of forced moves while SPLITs fly") {
  std::int64_t forced = 0, held = 0;
  bool leads = false;
  for (std::uint64_t seed = first_seed(), last = seed + kRuns; seed < last; ++seed) {
    CAPTURE(seed);
    Job job = holes(seed);
    job.moves = true;
    const Outcome outcome = stress(job);
    leads = outcome.leads;
    forced += outcome.forced;
    held += outcome.counters.held;
  }
  if (!leads) return;
  CHECK(forced > 500 * static_cast<std::int64_t>(kRuns) / kShrink);
  CHECK(held > 0);
}

TEST_CASE("no policy, moves are forced") {
  stress_policy("none");
}
TEST_CASE("a restless zoltan") {
  stress_policy("zoltan");
}
TEST_CASE("a restless diffusion") {
  stress_policy("diffusion");
}
TEST_CASE("a restless stealing") {
  stress_policy("stealing");
}
TEST_CASE("a restless greedy") {
  stress_policy("greedy");
}
