#pragma once

#include <memory>

#include "driftmesh/policy.hpp"
#include "driftmesh/policy_parameters.hpp"

namespace driftmesh::balancer {

/// Work stealing, one of the policies by name, and the one of threads.
[[nodiscard]] std::unique_ptr<Policy> make_stealing(Parameters& parameters);

}  // namespace driftmesh::balancer
