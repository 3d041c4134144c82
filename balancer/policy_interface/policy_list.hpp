#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "driftmesh/policy.hpp"
#include "driftmesh/policy_parameters.hpp"

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

/// The extension of a file that is a policy: a shared library, named in place of a policy.
inline constexpr const char* kPolicyLibrary = ".so";
[[nodiscard]] inline bool is_policy_library(std::string_view name) {
  return name.ends_with(kPolicyLibrary);
}

/// The name of a policy in parameters and tables: without the folder of a library.
[[nodiscard]] std::string short_name(const std::string& policy);

/// A parameter, and the policy that it is for, or nothing for any.
struct PolicyParameter {
  std::string policy;
  std::string name;
};
/// Takes "zoltan.method", "pairs.so.share" or "share".
[[nodiscard]] PolicyParameter split_parameter(const std::string& text);

/// Makes a policy by name with the user's parameters: make_policy (policies/policy_factory.hpp), for code that must not
/// depend on the policies themselves, which bring in Zoltan and MPI.
using PolicyMaker =
    std::function<std::shared_ptr<const Policy>(const std::string& name, const Parameters::Values& values)>;

}  // namespace driftmesh::balancer
