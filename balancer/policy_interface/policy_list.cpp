#include "balancer/policy_interface/policy_list.hpp"

namespace driftmesh::balancer {

std::vector<std::string> policy_names() {
#define NAME(POLICY) #POLICY,
  return {DRIFTMESH_POLICIES(NAME)};
#undef NAME
}

std::string short_name(const std::string& policy) {
  return is_policy_library(policy) ? policy.substr(policy.rfind('/') + 1) : policy;
}

PolicyParameter split_parameter(const std::string& text) {
  const std::size_t library = text.find(std::string(kPolicyLibrary) + ".");
  const std::size_t dot = text.find('.', library == std::string::npos ? 0 : library + 1);
  return dot == std::string::npos ? PolicyParameter{"", text}
                                  : PolicyParameter{text.substr(0, dot), text.substr(dot + 1)};
}

}  // namespace driftmesh::balancer
