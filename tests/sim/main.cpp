// driftmesh-sim: replays adversarial schedules of real meshing on simulated ranks, from their seeds.

#include <fmt/format.h>

#include <charconv>
#include <cstdint>
#include <exception>
#include <iostream>
#include <string>
#include <utility>

#include "base/standard_streams.hpp"
#include "base/stopwatch.hpp"
#include "cli/command_line.hpp"
#include "cli/values.hpp"
#include "driftmesh/error.hpp"
#include "sim/adversarial_run.hpp"
#include "sim/journey.hpp"

namespace {

using namespace driftmesh;
using namespace driftmesh::sim;

/// "7..12", or a single number.
std::pair<std::uint64_t, std::uint64_t> seed_range(const std::string& text) {
  const auto number = [&](std::string_view digits) {
    std::uint64_t value = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error != std::errc() || end != digits.data() + digits.size())
      throw Error("'" + text + "' is not a range of seeds; give two numbers, as in 1..1000");
    return value;
  };
  const std::size_t dots = text.find("..");
  if (dots == std::string::npos) return {number(text), number(text)};
  return {number(std::string_view(text).substr(0, dots)), number(std::string_view(text).substr(dots + 2))};
}

Outcome replay(std::uint64_t seed, const Choice& choice, Domains& domains) {
  const Scenario scenario = Scenario::from_seed(seed, choice);
  return AdversarialRun(scenario, domains[scenario.domain]).run();
}

/// Replays one seed and prints all results.
bool show(std::uint64_t seed, const Choice& choice, Domains& domains) {
  fmt::print("{}\n", Scenario::from_seed(seed, choice).describe());
  const Outcome o = replay(seed, choice, domains);
  for (const Verdict& v : o.verdicts) fmt::print("  {:<46} {}\n", v.oracle, v.problem.empty() ? "yes" : v.problem);
  fmt::print("  {} steps, {} triangles, digest {:016x}\n", o.steps, o.triangles, o.digest);
  fmt::print("  {} SPLITs in {} messages, {} subdomains moved, {} groups forwarded, {} times at most, {} held\n",
             o.counters.splits_sent, o.counters.batches_sent, o.counters.hand_offs, o.counters.forwarded,
             o.counters.most_hops, o.counters.held);
  fmt::print("  {}\n", words_of(o.effects));
  fmt::print("  {} messages delivered, {} of them reordered, {} copies; {} probes after the last work\n",
             o.network.delivered, o.network.reordered, o.network.copies, o.late_rounds);
  return o.failure().empty();
}

/// Makes journeys of many seeds, or of one, and prints failures and totals.
bool travel(std::uint64_t first, std::uint64_t last) {
  const Stopwatch watch;
  Journeys journeys;
  std::uint64_t failed = 0;
  for (std::uint64_t seed = first; seed <= last; ++seed) {
    const JourneyPlan plan = JourneyPlan::from_seed(seed);
    if (first == last) fmt::print("{}\n", plan.describe());
    const std::string problem = journeys.travel(plan);
    if (problem.empty()) continue;
    ++failed;
    fmt::print("{}\n  FAILED {}\n", plan.describe(), problem);
  }
  fmt::print("seeds {} to {}: {} failed\n", first, last, failed);
  fmt::print("{}; {:.1f} s\n", words_of(journeys.counts()), watch.seconds());
  return failed == 0;
}

/// Replays many seeds and prints failures and totals.
bool sweep(std::uint64_t first, std::uint64_t last, const Choice& choice, Domains& domains) {
  const Stopwatch watch;
  std::uint64_t failed = 0, compared = 0;
  std::int64_t triangles = 0, splits = 0, moves = 0, forwarded = 0, held = 0;
  AdversaryEffects effects;
  for (std::uint64_t seed = first; seed <= last; ++seed) {
    const Outcome o = replay(seed, choice, domains);
    if (const std::string failure = o.failure(); !failure.empty()) {
      ++failed;
      fmt::print("{}\n  FAILED {}\n", Scenario::from_seed(seed, choice).describe(), failure);
    }
    triangles += o.triangles;
    splits += o.counters.splits_sent;
    moves += o.counters.hand_offs;
    forwarded += o.counters.forwarded;
    held += o.counters.held;
    effects += o.effects;
    compared += o.digest_compared ? 1 : 0;
  }
  fmt::print("seeds {} to {}: {} failed\n", first, last, failed);
  fmt::print(
      "{} triangles, {} SPLITs, {} subdomains moved, {} groups forwarded, {} held; {} digests compared; {:.1f} s\n",
      triangles, splits, moves, forwarded, held, compared, watch.seconds());
  fmt::print("{}\n", words_of(effects));
  return failed == 0;
}

struct Request {
  std::uint64_t seed = 1;
  std::string seeds, presplit = "auto";
  bool faults = false;
  Choice choice;
};

int replay_all(Request& request) {
  if (request.presplit != "auto") request.choice.presplit = request.presplit == "on";
  if (request.faults) {
    const auto [first, last] = seed_range(request.seeds.empty() ? std::to_string(request.seed) : request.seeds);
    return travel(first, last) ? 0 : 1;
  }
  Domains domains;
  if (request.seeds.empty()) return show(request.seed, request.choice, domains) ? 0 : 1;
  const auto [first, last] = seed_range(request.seeds);
  return sweep(first, last, request.choice, domains) ? 0 : 1;
}

cli::Command program(Request& request) {
  Choice& choice = request.choice;
  return {.name = "driftmesh-sim",
          .summary = "Mesh small domains on simulated ranks with an adversarial network, and check everything",
          .options = {{.name = "seed",
                       .value = "N",
                       .help = "Replay this run, in detail",
                       .standard = "1",
                       .take = cli::into(request.seed)},
                      {.name = "seeds",
                       .value = "FIRST..LAST",
                       .help = "Replay these runs; print those that fail",
                       .take = cli::into(request.seeds)},
                      {.kind = cli::Option::Kind::kFlag,
                       .name = "faults",
                       .help = "Whole runs instead, whose ranks are killed, hung, slowed down and resumed on others",
                       .take = cli::into(request.faults)},
                      {.name = "ranks",
                       .value = "N",
                       .help = "Simulated ranks",
                       .standard = "from the seed",
                       .take = cli::into(choice.ranks, {1, 1000})},
                      {.name = "domain",
                       .value = "NAME",
                       .help = "Domain to mesh",
                       .standard = "from the seed",
                       .choices = domain_names(),
                       .take = cli::into(choice.domain)},
                      {.name = "mover",
                       .value = "NAME",
                       .help = "What moves subdomains: an adversary or a policy",
                       .standard = "from the seed",
                       .choices = mover_names(),
                       .take = cli::into(choice.mover)},
                      {.name = "presplit",
                       .value = "MODE",
                       .help = "Split interfaces to size first: on, off, or auto (from the seed)",
                       .standard = "auto",
                       .choices = {"on", "off", "auto"},
                       .take = cli::into(request.presplit)},
                      {.name = "aggregation",
                       .value = "K",
                       .help = "Most SPLITs in one message",
                       .standard = "from the seed",
                       .take = cli::into(choice.aggregation, cli::kPositive)}},
          .exit_codes = "0 no problems found, 1 problems found, 2 wrong usage",
          .run = [&request](const cli::Call& call) {
            if (call.has("seed") && call.has("seeds")) throw cli::UsageError("--seed and --seeds exclude each other");
            return replay_all(request);
          }};
}

}  // namespace

int main(int argc, char** argv) {
  try {
    Request request;
    const int code = cli::run(program(request), argc, argv);
    flush_standard_output();
    return code;
  } catch (const std::exception& error) {
    std::cerr << "driftmesh-sim: " << error.what() << '\n';
    return 2;
  }
}
