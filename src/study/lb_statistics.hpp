#pragma once

#include <string>
#include <vector>

#include "study/experiment_run.hpp"

namespace driftmesh::study {

/// A run in the format of DARMA vt's load balancing statistics, which LBAF reads: one JSON text per rank. The run time
/// is divided into run.request.lb_phases equal phases. In each, every subdomain is a task on the rank where it worked
/// longest, or that holds it at the end if it did not work, with the seconds that it worked there. Work of subdomains
/// on other ranks within the phase is a task that cannot move.
[[nodiscard]] std::vector<std::string> lb_statistics(const ExperimentRun& run);

}  // namespace driftmesh::study
