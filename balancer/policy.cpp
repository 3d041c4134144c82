#include "balancer/policy.hpp"

namespace driftmesh::balancer {

std::vector<Move> Policy::plan(const LoadSnapshot&, Rank) const {
  return {};
}

std::vector<Rank> Policy::parts(const LoadSnapshot& own, std::optional<int>) const {
  std::vector<Rank> owners;
  for (const SubdomainState& s : own.subdomains) owners.push_back(s.owner);
  return owners;
}

Dealing Policy::dealing(const LoadSnapshot&) const {
  return {};
}

bool Policy::runs_low(double) const {
  return false;
}

std::optional<Rank> Policy::victim(const LoadSnapshot&, Rank, const std::vector<bool>&) const {
  return std::nullopt;
}

std::vector<Move> Policy::give(const LoadSnapshot&, Rank, Rank) const {
  return {};
}

}  // namespace driftmesh::balancer
