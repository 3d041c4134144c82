#pragma once

#include <memory>
#include <string>

#include "balancer/policy_interface/policy_list.hpp"
#include "driftmesh/policy.hpp"
#include "driftmesh/policy_parameters.hpp"

namespace driftmesh::balancer {

/// The policy of that name (see policy_names), or of that shared library (see is_policy_library), with the user's
/// parameters (read in each policy's file). An unknown name, parameter or value is an InputError that suggests the
/// nearest valid one.
[[nodiscard]] std::unique_ptr<Policy> make_policy(const std::string& name, const Parameters::Values& values = {});

}  // namespace driftmesh::balancer
