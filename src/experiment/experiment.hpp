#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "balancer/conduct.hpp"
#include "base/error.hpp"
#include "cluster/cluster_spec.hpp"
#include "protocol/aggregator.hpp"
#include "runtime/run_plan.hpp"

namespace driftmesh::experiment {

/// One run, said completely. keys.cpp says what each field means, what it may be, and by what name files set it.
struct Experiment {
  std::string name = "experiment";
  std::string input_file;
  std::string generator;
  std::map<std::string, std::string> generator_parameters;

  double angle = 20;
  double area = 0;
  double triangles = 0;
  double triangles_per_rank = 0;
  bool region_areas = true;
  std::string size_expression;
  std::string size_background;
  double size_gradation = 0;
  double size_shortest = 0;
  double size_longest = 0;

  std::int32_t subdomains = 0;
  std::int32_t subdomains_per_rank = 0;
  std::string decomposition_file;
  double separator_angle = 60;
  double skew = 0;
  std::string mapping = "graph";
  bool mapping_by_speed = false;
  bool mapping_by_area = false;

  std::string cluster = "simulated";
  std::int32_t ranks = 0;
  double speed = 0;
  std::vector<RankGroup> groups;
  std::vector<double> drag;
  double latency = ClusterSpec{}.latency;
  double bandwidth = ClusterSpec{}.bandwidth;
  double message_overhead = ClusterSpec{}.message_overhead;

  std::string presplit = "auto";
  std::int64_t aggregation = protocol::Aggregator::kDefaultThreshold;
  std::string order = "given";
  std::int64_t slice = RunPlan{}.slice;

  std::string policy = "none";
  std::map<std::string, std::string> policy_parameters;
  double balance_look = balancer::ControllerOptions{}.look;
  double balance_gap = balancer::ControllerOptions{}.gap;
  double balance_interval = balancer::ControllerOptions{}.interval;
  double balance_gain = balancer::Worth{}.gain;

  std::int64_t seed = 1;
  std::int32_t repetitions = 1;
  bool pictures = true;
  std::int32_t lb_phases = 0;
};

/// A value that cannot be, or cannot be together with others; `key` is the one to look at.
class KeyError : public Error {
 public:
  KeyError(std::string key, const std::string& what, const std::string& next)
      : Error(key + ": " + what + "; " + next), key_(std::move(key)), what_(what), next_(next) {}
  [[nodiscard]] const std::string& key() const { return key_; }
  [[nodiscard]] const std::string& problem() const { return what_; }
  [[nodiscard]] const std::string& next() const { return next_; }

 private:
  std::string key_;
  std::string what_;
  std::string next_;
};

/// The parameters of the policy: of those that name one, as zoltan.method does, only the ones that name this. Throws
/// KeyError for a policy that does not exist.
[[nodiscard]] std::map<std::string, std::string> parameters_of_policy(const Experiment& experiment);

/// Throws KeyError for values that are missing or do not go together.
void check(const Experiment& experiment);

/// Throws KeyError if a run cannot be made by so many processes, which mpirun has started: 1 without it.
void check_processes(const Experiment& experiment, std::int32_t processes);

/// The cluster to simulate. A real one is whatever mpirun has started.
[[nodiscard]] ClusterSpec cluster_of(const Experiment& experiment);

}  // namespace driftmesh::experiment
