#pragma once

#include <cstdint>
#include <optional>

#include "adapt/fit_lengths.hpp"
#include "adapt/generation.hpp"
#include "adapt/regenerate.hpp"
#include "decompose/with_cuts.hpp"
#include "distributed/ranks.hpp"
#include "driftmesh/ids.hpp"
#include "runtime/run_plan.hpp"

namespace driftmesh::adapt {

/// The parts of a generation of which heavy ones are made of several.
struct Divided {
  Parts parts;     ///< with the separators inside, as in cut.with_separators
  CutFurther cut;  ///< by which they can be divided
};

/// What a division starts from. All outlive the call.
struct Dividing {
  const RunPlan& plan;       ///< whose decomposition is that of `before`
  std::int32_t shares;       ///< see granularity.hpp
  const Generation& before;  ///< the generation before
  const Wanted& wanted;      ///< what it wanted of the new one
  std::int32_t threads;
  const Hooks& hooks;
};

/// Makes heavy ones of the new parts again, with separators inside; the others stay as they are, but for points on
/// borders. What is divided does not depend on ranks and threads. Nothing: there are none, or none can be cut.
/// Collective.
[[nodiscard]] std::optional<Divided> divide_heavy(const Parts& parts, const Dividing& how, Ranks& ranks);

}  // namespace driftmesh::adapt
