#pragma once

#include <memory>
#include <string>
#include <vector>

#include "balancer/parameters.hpp"
#include "balancer/policy.hpp"

namespace driftmesh::balancer {

/// The names that make_policy knows.
[[nodiscard]] std::vector<std::string> policy_names();

/// The policy of that name, with the parameters that a user wrote (each policy's file reads its own). An unknown
/// name, parameter or value is an InputError that says what was probably meant.
[[nodiscard]] std::unique_ptr<Policy> make_policy(const std::string& name, const Parameters::Values& values = {});

}  // namespace driftmesh::balancer
