#include <memory>

#include "driftmesh/policy.hpp"
#include "driftmesh/policy_parameters.hpp"

namespace driftmesh::balancer {
namespace {

/// Leaves every subdomain where it is.
class None final : public Policy {
 public:
  [[nodiscard]] Placement placement() const override { return Placement::kNobody; }
};

}  // namespace

std::unique_ptr<Policy> make_none(Parameters&) {
  return std::make_unique<None>();
}

}  // namespace driftmesh::balancer
