#pragma once

#include "decompose/decomposition.hpp"
#include "decompose/extract_subdomain.hpp"
#include "driftmesh/id_vector.hpp"
#include "driftmesh/ids.hpp"

namespace driftmesh {

/// A decomposition in which groups of subdomains have become one each, without the separators inside, and what of it
/// is where. What stays keeps its order. Where a separator no longer ends, a chain of roots that are the halves of one
/// is that one again.
struct JoinedSubdomains {
  Decomposition decomposition;
  IdVector<SubdomainId, SubdomainId> whole;    ///< what each subdomain has become, or is a part of
  IdVector<GlobalRootId, RootInterval> roots;  ///< the interval that each root has become; root kNone: it is gone
  struct Place {
    GlobalPointId point = kNoPoint;      ///< its number,
    RootInterval halved{.root = kNone};  ///< or else the interval of which it is the midpoint; none: it is gone
  };
  IdVector<GlobalPointId, Place> points;
};

/// `group`: for each subdomain the lowest number of those that it is joined with, its own if with none; they are
/// connected by separators.
[[nodiscard]] JoinedSubdomains with_joins(const Decomposition& decomposition,
                                          const IdVector<SubdomainId, SubdomainId>& group);

}  // namespace driftmesh
