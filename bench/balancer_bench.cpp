// Planning time of every policy that plans for all ranks, on a square of subdomains mapped in rows to ranks of three
// speeds. Counts the planned moves, and those worth making.
#include <benchmark/benchmark.h>

#include "balancer/cost/move_cost.hpp"
#include "balancer/policies/policy_factory.hpp"
#include "support/load_snapshots.hpp"

using namespace driftmesh;
using namespace driftmesh::balancer;

namespace {

LoadSnapshot snapshot_of(int subdomains, int ranks) {
  const int rows = static_cast<int>(std::sqrt(subdomains));
  Layout layout = testing::grid_layout(subdomains / rows, rows, ranks);
  std::mt19937_64 random(1);
  for (auto& s : layout.subdomains) s.predicted = 20e3 * std::uniform_real_distribution<double>(0.7, 1.3)(random);
  IdVector<Rank, double> speeds;
  for (int r = 0; r < ranks; ++r) speeds.push_back(9 * r < 4 * ranks ? 110e3 : 9 * r < 5 * ranks ? 92e3 : 186e3);
  return testing::initial_snapshot(std::move(layout), speeds);
}

void plan(benchmark::State& state, const std::string& name, const Parameters::Values& parameters) {
  const LoadSnapshot snapshot = snapshot_of(static_cast<int>(state.range(0)), static_cast<int>(state.range(1)));
  const auto policy = make_policy(name, parameters);
  std::vector<Move> planned, worth;
  for (auto _ : state) {
    planned = policy->plan(snapshot, Rank{0});
    worth = worth_moving(snapshot, planned, {});
    benchmark::DoNotOptimize(worth.data());
  }
  state.counters["planned"] = static_cast<double>(planned.size());
  state.counters["worth"] = static_cast<double>(worth.size());
  state.counters["time/ideal"] = finishing_time(after(snapshot, worth)) / ideal_time(snapshot);
}

void all_sizes(benchmark::internal::Benchmark* b) {
  b->Args({4'000, 8})->Args({4'000, 144})->Args({100'000, 1'000})->Unit(benchmark::kMillisecond);
}

}  // namespace

int main(int argc, char** argv) {
  const auto add = [](const std::string& label, const std::string& policy, const Parameters::Values& parameters) {
    benchmark::RegisterBenchmark(label.c_str(), plan, policy, parameters)->Apply(all_sizes);
  };
  add("greedy", "greedy", {});
  for (const char* method : {"rcb", "hsfc"}) add(std::string("zoltan ") + method, "zoltan", {{"method", method}});
  for (const char* method : {"graph", "hypergraph"})
    for (const char* approach : {"partition", "repartition", "refine"})
      add(std::string("zoltan ") + method + ' ' + approach, "zoltan", {{"method", method}, {"approach", approach}});
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
