#pragma once

#include "adapt/session.hpp"
#include "api/call.hpp"
#include "driftmesh/id_vector.hpp"
#include "job/here.hpp"
#include "job/make.hpp"

namespace driftmesh::testing {

/// The first generation of an adaptive mesh, as AdaptiveMesh makes it.
inline job::LiveMesh first_generation(const Pslg& input, const MeshOptions& options) {
  Call call(input, options);
  job::Here here(job::kSubdomains, 1);
  job::RunRecord record;
  return job::make(call.asked(here.kind()), here, record, call.watch())->take_live(call.request());
}

/// The part of it that a rank holds.
inline adapt::Start start_on(Rank rank, const job::LiveMesh& live, const IdVector<SubdomainId, Rank>& holders) {
  adapt::Start start{live.plan, live.pslg, {}, {}};
  start.plan.policy.reset();
  for (const auto& [s, part] : live.parts)
    if (holders[s] == rank) start.parts[s] = part;
  for (const auto& [s, lengths] : live.lengths)
    if (holders[s] == rank) start.lengths[s] = lengths;
  return start;
}

}  // namespace driftmesh::testing
