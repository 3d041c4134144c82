#pragma once

#include <string>

#include "driftmesh/policy_parameters.hpp"

namespace driftmesh::testing {

/// The name and parameters of a policy for the factory.
struct PolicyCalled {
  std::string name;
  balancer::Parameters::Values parameters;
};

/// The tests' names of policies: the factory's own, and "collective" for Zoltan on all ranks at once.
inline PolicyCalled policy_called(const std::string& name) {
  if (name == "collective") return {"zoltan", {{"placement", "collective"}}};
  return {name, {}};
}

}  // namespace driftmesh::testing
