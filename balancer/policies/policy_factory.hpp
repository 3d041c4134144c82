#pragma once

#include <memory>
#include <string>

#include "balancer/parameters.hpp"
#include "balancer/policy_list.hpp"
#include "driftmesh/policy.hpp"

namespace driftmesh::balancer {

/// The policy of that name (see policy_names), with the parameters that a user wrote (each policy's file reads its
/// own). An unknown name, parameter or value is an InputError that says what was probably meant.
[[nodiscard]] std::unique_ptr<Policy> make_policy(const std::string& name, const Parameters::Values& values = {});

}  // namespace driftmesh::balancer
