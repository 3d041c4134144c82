#include "balancer/policies/policy_factory.hpp"

#include <algorithm>

#include "balancer/policies/policy_library.hpp"
#include "balancer/policy_interface/policy_list.hpp"
#include "balancer/stealing/policy_stealing.hpp"
#include "base/nearest_name.hpp"
#include "driftmesh/error.hpp"

namespace driftmesh::balancer {

#define DECLARE(NAME) std::unique_ptr<Policy> make_##NAME(Parameters& parameters);
DRIFTMESH_POLICIES(DECLARE)
#undef DECLARE

namespace {

struct Entry {
  const char* name;
  std::unique_ptr<Policy> (*make)(Parameters&);
};

#define ENTRY(NAME) {#NAME, make_##NAME},
constexpr Entry kPolicies[] = {DRIFTMESH_POLICIES(ENTRY)};
#undef ENTRY

}  // namespace

std::unique_ptr<Policy> make_policy(const std::string& name, const Parameters::Values& values) {
  if (is_policy_library(name)) return make_policy_of_library(name, values);
  const auto* const entry =
      std::find_if(std::begin(kPolicies), std::end(kPolicies), [&](const Entry& known) { return name == known.name; });
  if (entry == std::end(kPolicies))
    throw InputError("unknown policy '" + name + "'; the nearest one is '" + nearest_name(name, policy_names()) + "'");
  Parameters parameters(name, values);
  auto policy = entry->make(parameters);
  parameters.finish();
  return policy;
}

}  // namespace driftmesh::balancer
