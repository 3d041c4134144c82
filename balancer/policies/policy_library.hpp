#pragma once

#include <memory>
#include <string>

#include "driftmesh/policy.hpp"
#include "driftmesh/policy_parameters.hpp"

namespace driftmesh::balancer {

/// The policy of a shared library (driftmesh/policy_library.hpp), which stays loaded. Errors: InputError that names the
/// file, where it cannot be loaded, is no such library, or was made for another version; and as make_policy.
[[nodiscard]] std::unique_ptr<Policy> make_policy_of_library(const std::string& file, const Parameters::Values& values);

}  // namespace driftmesh::balancer
