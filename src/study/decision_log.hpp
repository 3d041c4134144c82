#pragma once

#include <string>

#include "cluster/cluster_run.hpp"
#include "config/value_json.hpp"

namespace driftmesh::study {

/// What planners considered and what moved, in the order of time: a line of JSON for each. docs/experiments.md
/// describes the lines.
[[nodiscard]] std::string decision_lines(const ClusterRun& run);

/// What is to be said of a deliberation besides its time and rank.
[[nodiscard]] config::Json json_of(const balancer::Deliberation& considered);

}  // namespace driftmesh::study
