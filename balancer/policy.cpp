#include "balancer/policy.hpp"

namespace driftmesh::balancer {

std::vector<Move> Policy::plan(const LoadSnapshot&, Rank) const {
  return {};
}

std::optional<Rank> Policy::ask(const LoadSnapshot&, Rank, const std::vector<bool>&) const {
  return std::nullopt;
}

std::vector<Move> Policy::give(const LoadSnapshot&, Rank, Rank) const {
  return {};
}

}  // namespace driftmesh::balancer
