#include "balancer/mpi/mpi_council.hpp"

#include <utility>

#include "balancer/plan_jointly.hpp"
#include "balancer/zoltan/zoltan_partition.hpp"
#include "base/bytes.hpp"

namespace driftmesh::balancer {

MpiCouncil::MpiCouncil(protocol::MpiTransport& transport, std::shared_ptr<const Layout> layout,
                       std::shared_ptr<const Policy> policy, const ControllerOptions& options)
    : transport_(transport), layout_(std::move(layout)), policy_(std::move(policy)), options_(options) {}

// The contributions of all ranks, concatenated in rank order.
template <class T>
std::vector<T> MpiCouncil::from_all(const std::vector<T>& own) {
  ByteWriter writer;
  writer.array(own);
  std::vector<T> all, some;
  for (const Bytes& bytes : transport_.all_gather(writer.take())) {
    ByteReader(bytes).array(some);
    all.insert(all.end(), some.begin(), some.end());
  }
  return all;
}

std::optional<Council::Decision> MpiCouncil::decide(std::uint32_t, const Contribution& contribution) {
  const IdVector<Rank, RankLoad> states(from_all<RankLoad>({contribution.state}));
  const LoadSnapshot own = own_snapshot(contribution, layout_, states);
  const Dealing dealing = policy_->dealing(own);
  const auto partitioning = policy_->partitioning(own);
  const std::vector<std::vector<Part>> parts{
      partitioning ? zoltan_partition(own, *partitioning, transport_.communicator()) : present_parts(own)};
  return plan_jointly({&contribution, 1}, parts, states, dealing, options_,
                      [this](const auto& told) { return from_all(told); })
      .front();
}

std::unique_ptr<Council> make_mpi_council(protocol::MpiTransport& transport, std::shared_ptr<const Layout> layout,
                                          std::shared_ptr<const Policy> policy, const ControllerOptions& options) {
  if (!policy || policy->placement() != Placement::kCollective) return nullptr;
  return std::make_unique<MpiCouncil>(transport, std::move(layout), std::move(policy), options);
}

}  // namespace driftmesh::balancer
