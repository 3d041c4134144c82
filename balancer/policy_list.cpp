#include "balancer/policy_list.hpp"

namespace driftmesh::balancer {

std::vector<std::string> policy_names() {
#define NAME(POLICY) #POLICY,
  return {DRIFTMESH_POLICIES(NAME)};
#undef NAME
}

}  // namespace driftmesh::balancer
