#include "balancer/policy.hpp"

namespace driftmesh::balancer {

std::vector<Move> Policy::plan(const LoadSnapshot&, Rank) const {
  return {};
}

std::optional<ZoltanParameters> Policy::partitioning(const LoadSnapshot&) const {
  return std::nullopt;
}

Dealing Policy::dealing(const LoadSnapshot&) const {
  return {};
}

bool Policy::runs_low(double) const {
  return false;
}

std::optional<Rank> Policy::victim(const LoadSnapshot&, Rank, const IdVector<Rank, bool>&) const {
  return std::nullopt;
}

std::vector<Move> Policy::give(const LoadSnapshot&, Rank, Rank) const {
  return {};
}

}  // namespace driftmesh::balancer
