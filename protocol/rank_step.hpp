#pragma once

#include <cstdint>
#include <functional>

#include "protocol/transport.hpp"

namespace driftmesh::protocol {

/// Result of one round of a rank's loop.
enum class StepResult {
  kBusy,      ///< there is more to do
  kIdle,      ///< nothing to do until a message arrives
  kFinished,  ///< the rank has left the run; it is not stepped again
};

/// One round of a rank's loop: poll, dispatch, work for a slice. On a real rank run_rank repeats it; on simulated ranks
/// the network decides who steps next.
using RankStep = std::function<StepResult()>;

/// The loop of a real rank.
inline void run_rank(Transport& transport, const RankStep& step) {
  for (auto result = step(); result != StepResult::kFinished; result = step())
    if (result == StepResult::kIdle) transport.idle();
}

enum class RunEnd {
  kFinished,   ///< every rank has
  kStalled,    ///< all others are idle, and no message is in transit
  kStepLimit,  ///< stopped by the limit on steps
};

struct RunResult {
  RunEnd end = RunEnd::kFinished;
  std::uint64_t steps = 0;
};

}  // namespace driftmesh::protocol
