#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "decompose/presplit.hpp"
#include "decompose/subdomain_mesh.hpp"
#include "mesh/refiner.hpp"
#include "support/split_points.hpp"

namespace driftmesh::testing {

struct RefineTogether {
  int most_rounds = 100;
  bool presplit = false;                        ///< whether interfaces are split to size first
  std::int64_t most_triangles = kMaxTriangles;  ///< all stop when one subdomain has as many
};

struct RefinedTogether {
  IdVector<SubdomainId, SubdomainMesh> parts;
  int rounds = 0;             ///< exchanges with new points
  std::size_t exchanged = 0;  ///< split points that one side had before the other
  std::size_t refused = 0;    ///< split points that the other side could not insert
  std::vector<std::string> not_conforming;
  bool complete = true;  ///< false: stopped at the limit of triangles
};

/// Refines all subdomains of a decomposition in one process, as ranks would: each on its own, then split points on
/// shared roots are exchanged until nothing changes.
inline RefinedTogether refine_together(const Decomposition& d, const QualityBounds& bounds,
                                       const RefineTogether& how = {}) {
  RefinedTogether result;
  IdVector<SubdomainId, std::unique_ptr<Refiner>> refiners;
  for (const SubdomainId i : ids_of(d.subdomains)) result.parts.push_back(subdomain_triangulation(d, i));
  for (SubdomainMesh& part : result.parts) {
    refiners.push_back(std::make_unique<Refiner>(part.mesh, bounds));
    refiners.back()->limit_triangles(how.most_triangles);
    for (const RootId r : ids_of(part.roots))
      for (const dyadic::Path path :
           how.presplit ? presplit_paths(d, part.roots[r], bounds) : std::vector<dyadic::Path>{})
        (void)refiners.back()->add_split_point(r, path);
  }
  const auto refine_all = [&] {
    for (auto& refiner : refiners) result.complete = result.complete && refiner->refine() == Refiner::Status::kDone;
  };
  refine_all();
  for (bool changed = true; changed && result.complete && result.rounds < how.most_rounds;) {
    changed = false;
    std::map<GlobalRootId, std::set<dyadic::Path>> all;
    IdVector<SubdomainId, SplitPoints> own;
    for (const SubdomainMesh& part : result.parts) {
      own.push_back(split_points(part));
      for (const auto& [root, points] : own.back())
        for (const auto& point : points) all[root].insert(point.first);
    }
    for (const SubdomainId i : ids_of(d.subdomains)) {
      bool told = false;
      for (const RootId r : ids_of(result.parts[i].roots))
        for (const dyadic::Path path : all[result.parts[i].roots[r]]) {
          if (own[i][result.parts[i].roots[r]].contains(path)) continue;
          told = true;
          result.refused += !refiners[i]->add_split_point(r, path);
          ++result.exchanged;
        }
      changed |= told;
    }
    if (changed) ++result.rounds;
    refine_all();
  }
  SplitPoints first;
  for (const SubdomainId i : ids_of(d.subdomains))
    for (const GlobalRootId r : not_conforming_roots(result.parts[i], first))
      result.not_conforming.push_back("root " + to_string(r) + " in subdomain " + to_string(i));
  return result;
}

}  // namespace driftmesh::testing
