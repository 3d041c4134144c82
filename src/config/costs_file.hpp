#pragma once

#include <string>

#include "runtime/run_plan.hpp"

namespace driftmesh::config {

/// The costs of work as a YAML file, with the names of CostModel; `driftmesh calibrate` writes it.
[[nodiscard]] std::string costs_text(const CostModel& costs);

/// Costs that the file does not name keep their defaults. Throws InputError for an unknown name, or a value that is not
/// a number of seconds.
[[nodiscard]] CostModel read_costs(const std::string& path);

}  // namespace driftmesh::config
