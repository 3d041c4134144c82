#pragma once

#include <span>

#include "base/bytes.hpp"
#include "driftmesh/pslg.hpp"
#include "runtime/run_plan.hpp"

namespace driftmesh {

/// A plan as bytes, for ranks of the same program on machines of the same kind (arrays are stored as they are in
/// memory). Without the size field: each rank makes its own.
[[nodiscard]] Bytes plan_to_bytes(const RunPlan& plan);

/// The same for a file: the ranks that go on with it are others, and so the plan has no policy, and rank 0 owns all.
[[nodiscard]] Bytes plan_for_file(RunPlan plan);

/// The plan that plan_to_bytes was given, for this number of ranks, without its size field. `policies` makes its
/// policy, as in plan_run. Throws Error if the bytes are not such a plan.
[[nodiscard]] RunPlan plan_from_bytes(std::span<const std::byte> bytes, std::int32_t ranks,
                                      const balancer::PolicyMaker& policies = nullptr);

/// The same for the input of a run.
[[nodiscard]] Bytes pslg_to_bytes(const Pslg& pslg);
[[nodiscard]] Pslg pslg_from_bytes(std::span<const std::byte> bytes);

}  // namespace driftmesh
