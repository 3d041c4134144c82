#pragma once

#include <memory>

#include "balancer/conduct.hpp"
#include "balancer/council.hpp"
#include "driftmesh/policy.hpp"
#include "protocol/mpi/mpi_transport.hpp"

namespace driftmesh::balancer {

/// The council of real ranks, which plan at the same time, each for its own subdomains, on the communicator of a
/// transport.
class MpiCouncil final : public Council {
 public:
  /// `transport` must outlive it.
  MpiCouncil(protocol::MpiTransport& transport, std::shared_ptr<const Layout> layout,
             std::shared_ptr<const Policy> policy, const ControllerOptions& options);

  /// Waits for all ranks of the communicator.
  [[nodiscard]] std::optional<Decision> decide(std::uint32_t round, const Contribution& contribution) override;

 private:
  template <class T>
  [[nodiscard]] std::vector<T> from_all(const std::vector<T>& own);

  protocol::MpiTransport& transport_;
  std::shared_ptr<const Layout> layout_;
  std::shared_ptr<const Policy> policy_;
  ControllerOptions options_;
};

/// The council for plans of this policy; null if it does not plan collectively.
[[nodiscard]] std::unique_ptr<Council> make_mpi_council(protocol::MpiTransport& transport,
                                                        std::shared_ptr<const Layout> layout,
                                                        std::shared_ptr<const Policy> policy,
                                                        const ControllerOptions& options);

}  // namespace driftmesh::balancer
