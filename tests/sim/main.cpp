// driftmesh-sim: replays adversarial schedules of real meshing on simulated ranks, from their seeds.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <cstdint>
#include <exception>
#include <iostream>
#include <string>
#include <utility>

#include "base/error.hpp"
#include "base/stopwatch.hpp"
#include "sim/adversarial_run.hpp"

namespace {

using namespace driftmesh;
using namespace driftmesh::sim;

/// "7..12"; one number stands for itself.
std::pair<std::uint64_t, std::uint64_t> seed_range(const std::string& text) {
  const auto number = [&](std::string_view digits) {
    std::uint64_t value = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error != std::errc() || end != digits.data() + digits.size())
      throw Error("'" + text + "' is no range of seeds; give two numbers, as in 1..1000");
    return value;
  };
  const std::size_t dots = text.find("..");
  if (dots == std::string::npos) return {number(text), number(text)};
  return {number(std::string_view(text).substr(0, dots)), number(std::string_view(text).substr(dots + 2))};
}

Outcome replay(std::uint64_t seed, const Choice& choice, Domains& domains) {
  const Scenario scenario = Scenario::from_seed(seed, choice);
  return AdversarialRun<>(scenario, domains[scenario.domain]).run();
}

/// One seed, with everything that is known of it.
bool show(std::uint64_t seed, const Choice& choice, Domains& domains) {
  fmt::print("{}\n", Scenario::from_seed(seed, choice).describe());
  const Outcome o = replay(seed, choice, domains);
  for (const Verdict& v : o.verdicts) fmt::print("  {:<46} {}\n", v.oracle, v.problem.empty() ? "yes" : v.problem);
  fmt::print("  {} steps, {} triangles, digest {:016x}\n", o.steps, o.triangles, o.digest);
  fmt::print("  {} SPLITs in {} messages, {} subdomains moved, {} groups forwarded, {} times at most, {} held\n",
             o.counters.splits_sent, o.counters.batches_sent, o.counters.hand_offs, o.counters.forwarded,
             o.counters.most_hops, o.counters.held);
  fmt::print("  {}\n", words_of(o.deeds));
  fmt::print("  {} messages delivered, {} of them reordered, {} copies; {} probes after the last work\n",
             o.network.delivered, o.network.reordered, o.network.copies, o.late_rounds);
  return o.failure().empty();
}

/// Many seeds: those that fail, and sums.
bool sweep(std::uint64_t first, std::uint64_t last, const Choice& choice, Domains& domains) {
  const Stopwatch watch;
  std::uint64_t failed = 0, compared = 0;
  std::int64_t triangles = 0, splits = 0, moves = 0, forwarded = 0, held = 0;
  Deeds deeds;
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
    deeds += o.deeds;
    compared += o.digest_compared ? 1 : 0;
  }
  fmt::print("seeds {} to {}: {} failed\n", first, last, failed);
  fmt::print(
      "{} triangles, {} SPLITs, {} subdomains moved, {} groups forwarded, {} held; {} digests compared; {:.1f} s\n",
      triangles, splits, moves, forwarded, held, compared, watch.seconds());
  fmt::print("{}\n", words_of(deeds));
  return failed == 0;
}

int run(int argc, char** argv) {
  CLI::App program{"Meshes small domains on simulated ranks whose network does its worst, and checks everything"};
  std::uint64_t seed = 1;
  std::string seeds, presplit = "auto";
  Choice choice;
  auto* const one = program.add_option("--seed", seed, "Replay this run, in detail")->capture_default_str();
  program.add_option("--seeds", seeds, "Replay these runs, FIRST..LAST; print those that fail")->excludes(one);
  program.add_option("--ranks", choice.ranks, "Simulated ranks (left out: from the seed)")->check(CLI::Range(1, 1000));
  program.add_option("--domain", choice.domain, "What is meshed (left out: from the seed)")
      ->check(CLI::IsMember(domain_names()));
  program
      .add_option("--mover", choice.mover, "Who moves subdomains: an adversary or a policy (left out: from the seed)")
      ->check(CLI::IsMember(mover_names()));
  program.add_option("--presplit", presplit, "Cut interfaces to size first; auto: from the seed")
      ->check(CLI::IsMember({"on", "off", "auto"}))
      ->capture_default_str();
  program.add_option("--aggregation", choice.aggregation, "SPLITs in one message at most (left out: from the seed)")
      ->check(CLI::PositiveNumber);
  program.footer("Exit code: 0 all oracles are content, 1 one is not, 2 wrong usage.");
  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return program.exit(error) == 0 ? 0 : 2;
  }
  if (presplit != "auto") choice.presplit = presplit == "on";
  Domains domains;
  if (seeds.empty()) return show(seed, choice, domains) ? 0 : 1;
  const auto [first, last] = seed_range(seeds);
  return sweep(first, last, choice, domains) ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    std::cerr << "driftmesh-sim: " << error.what() << '\n';
    return 2;
  }
}
