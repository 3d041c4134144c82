#pragma once

#include <string>
#include <vector>

#include "app/experiment_run.hpp"

namespace driftmesh::app {

/// A run in the form in which DARMA vt writes what its load balancers saw, and LBAF reads it: one JSON text a rank. The
/// time of the run is divided into run.request.lb_phases equal phases. In each, every subdomain is a task of the
/// rank where it worked longest, or of the one that holds it at the end if it did not work, with the seconds that it
/// worked there. Seconds that subdomains worked elsewhere within the phase are a task that cannot move.
[[nodiscard]] std::vector<std::string> lb_statistics(const ExperimentRun& run);

}  // namespace driftmesh::app
