#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "balancer/parameters.hpp"
#include "driftmesh/policy.hpp"

// All policies: a line each. The one of name X is made by make_X, which lies in the policy's own file.
#define DRIFTMESH_POLICIES(POLICY) \
  POLICY(none)                     \
  POLICY(zoltan)                   \
  POLICY(diffusion)                \
  POLICY(stealing)                 \
  POLICY(greedy)

namespace driftmesh::balancer {

/// Their names.
[[nodiscard]] std::vector<std::string> policy_names();

/// Makes the policy of a name with the parameters that a user wrote: make_policy (policies/policy_factory.hpp), for
/// those who may not depend on the policies themselves, which bring Zoltan and MPI with them.
using PolicyMaker =
    std::function<std::shared_ptr<const Policy>(const std::string& name, const Parameters::Values& values)>;

}  // namespace driftmesh::balancer
