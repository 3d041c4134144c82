#pragma once

#include <memory>

#include "decompose/decomposition.hpp"
#include "distributed/census.hpp"
#include "driftmesh/id_vector.hpp"
#include "job/mesh_facts.hpp"
#include "mesh/bounds.hpp"
#include "migration/subdomain.hpp"
#include "runtime/run_plan.hpp"

namespace driftmesh::job {

/// The facts of the subdomains of a run, taken one by one. Threads may note different subdomains at once.
class FactsBook {
 public:
  /// `decomposition` must outlive the object.
  explicit FactsBook(const Decomposition& decomposition)
      : decomposition_(decomposition), pages_(decomposition.size()) {}

  /// Inspects a subdomain that has been refined to `bounds`; what was noted about it before no longer holds. Vertices
  /// and subsegments on roots count for the subdomain that numbers them.
  void note(const Subdomain& subdomain, const QualityBounds& bounds);
  [[nodiscard]] bool has(SubdomainId id) const { return pages_[id] != nullptr; }
  /// Only if it has them.
  [[nodiscard]] const MeshFacts& of(SubdomainId id) const { return pages_[id]->facts; }
  [[nodiscard]] const SubdomainCensus& census_of(SubdomainId id) const { return pages_[id]->census; }

 private:
  struct Page {
    MeshFacts facts;
    SubdomainCensus census;
  };

  const Decomposition& decomposition_;
  IdVector<SubdomainId, std::unique_ptr<const Page>> pages_;
};

/// Whether to inspect each subdomain when it is finished, while its mesh is in the cache and awake, rather than all at
/// the end: if its neighbors will not change it any more, or it goes to sleep.
[[nodiscard]] inline bool inspects_at_once(const RunPlan& plan) {
  return plan.presplit || plan.work.sleep;
}

}  // namespace driftmesh::job
