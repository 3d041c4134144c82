#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "balancer/parameters.hpp"
#include "driftmesh/policy.hpp"

// All policies, one line each. Policy X is made by make_X, defined in its own file.
#define DRIFTMESH_POLICIES(POLICY) \
  POLICY(none)                     \
  POLICY(zoltan)                   \
  POLICY(diffusion)                \
  POLICY(stealing)                 \
  POLICY(greedy)

namespace driftmesh::balancer {

/// Their names.
[[nodiscard]] std::vector<std::string> policy_names();

/// Makes a policy by name with the user's parameters: make_policy (policies/policy_factory.hpp), for code that must not
/// depend on the policies themselves, which bring in Zoltan and MPI.
using PolicyMaker =
    std::function<std::shared_ptr<const Policy>(const std::string& name, const Parameters::Values& values)>;

}  // namespace driftmesh::balancer
