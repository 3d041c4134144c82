#pragma once

#include <memory>

#include "balancer/policy_interface/policy_list.hpp"

namespace driftmesh::balancer {

/// Work stealing, one of the policies by name, and the one of threads.
[[nodiscard]] std::unique_ptr<Policy> make_stealing(Parameters& parameters);
/// For plans whose only policy it is.
[[nodiscard]] PolicyMaker stealing_maker();

}  // namespace driftmesh::balancer
