#pragma once

#include <map>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "decompose/decomposition.hpp"
#include "runtime/rank_loop.hpp"

namespace driftmesh::testing {

/// Rank loops on a simulated network (AdversarialNetwork or VirtualNetwork), all in this process.
template <class Rules = protocol::SoundRules>
struct SimulatedRanks {
  using Loop = BasicRankLoop<Rules>;
  std::vector<std::unique_ptr<Loop>> loops;
  std::vector<protocol::RankStep> steps;

  template <class Network>
  SimulatedRanks(Network& network, protocol::Rank ranks, const RunPlan& plan, const CostModel& costs = {}) {
    for (protocol::Rank r = 0; r < ranks; ++r)
      loops.push_back(std::make_unique<Loop>(network.transport(r), plan, costs));
    for (const auto& loop : loops) steps.push_back([l = loop.get()] { return l->step(); });
  }

  [[nodiscard]] std::vector<const Subdomain*> subdomains() const {
    std::vector<const Subdomain*> all;
    for (const auto& loop : loops)
      for (const auto& [id, subdomain] : loop->subdomains()) all.push_back(&subdomain);
    return all;
  }
};

/// The split points of each root of one subdomain, with coordinates.
inline std::map<RootId, std::map<dyadic::Path, Point>> split_points_of(const SubdomainMesh& part) {
  std::map<RootId, std::map<dyadic::Path, Point>> points;
  for (const Subsegment& s : part.mesh.subsegments)
    if (!s.is_leaf()) {
      const VertexId middle = part.mesh.subsegments[Triangulation::id(s.child)].vertex[1];
      points[part.roots[Triangulation::id(s.root)]][s.path] = part.mesh.points[Triangulation::id(middle)];
    }
  return points;
}

/// What is wrong with the parts as one mesh: subdomains that are missing or live twice, and shared edges whose sides
/// hold different points.
inline std::vector<std::string> conformity_problems(const Decomposition& d,
                                                    const std::vector<const Subdomain*>& subdomains) {
  std::vector<std::string> problems;
  std::set<SubdomainId> seen;
  std::map<RootId, std::map<dyadic::Path, Point>> first;
  for (const Subdomain* s : subdomains) {
    if (!seen.insert(s->id()).second) problems.push_back("subdomain " + std::to_string(s->id()) + " lives twice");
    if (!s->started() || s->active()) {
      problems.push_back("subdomain " + std::to_string(s->id()) + " is not finished");
      continue;
    }
    auto own = split_points_of(s->mesh());
    for (const RootId r : s->mesh().roots) {
      const auto [entry, is_new] = first.emplace(r, own[r]);
      if (!is_new && entry->second != own[r])
        problems.push_back("root " + std::to_string(r) + " of subdomain " + std::to_string(s->id()) +
                           " does not conform");
    }
  }
  if (seen.size() != d.size()) problems.push_back(std::to_string(d.size() - seen.size()) + " subdomains are missing");
  return problems;
}

}  // namespace driftmesh::testing
