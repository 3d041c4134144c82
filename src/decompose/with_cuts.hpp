#pragma once

#include <span>

#include "decompose/decomposition.hpp"
#include "decompose/extract_subdomain.hpp"
#include "decompose/further_cut.hpp"
#include "driftmesh/id_vector.hpp"
#include "driftmesh/ids.hpp"

namespace driftmesh {

/// A decomposition with cuts, step by step: what was there keeps its numbers, but that only the first interval of a
/// broken root does, and what is added is behind it.
struct CutFurther {
  Decomposition broken;           ///< roots are broken where separators will end
  Decomposition with_separators;  ///< and there are separators inside the subdomains that are to be divided
  Decomposition divided;          ///< and these are; the first part keeps the number of the whole
  RenamedRoots renamed;
  IdVector<SubdomainId, SubdomainId> whole_of;  ///< which one each subdomain was, or was part of
};

/// `cuts`: of different subdomains, ascending.
[[nodiscard]] CutFurther with_cuts(const Decomposition& decomposition, std::span<const FurtherCut> cuts);

}  // namespace driftmesh
