#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "base/failure.hpp"
#include "distributed/exchange.hpp"

namespace driftmesh {

/// The failure of some work, or none.
[[nodiscard]] Failure failure_in(const std::function<void()>& work);

/// The outcome of a rank's work, shared with all ranks.
[[nodiscard]] std::vector<Mail> status_to_all(std::int32_t ranks, const std::function<void()>& work);

/// What all ranks do with it: nothing, if nobody failed.
void throw_first_failure(const std::vector<Mail>& statuses);

}  // namespace driftmesh
