#pragma once

#include <doctest/doctest.h>

#include "driftmesh/error.hpp"
#include "support/simulated_run.hpp"

namespace driftmesh::testing {

/// Lets a rank whose step throws abandon the run, as it must be able to, and counts such steps.
inline void abandon_on_errors(SimulatedRanks& run, int& failures) {
  for (const Rank r : ids_of(run.loops))
    run.steps[r] = [&failures, loop = run.loops[r].get()] {
      try {
        return loop->step();
      } catch (const Error&) {
        REQUIRE(loop->can_abandon());
        ++failures;
        loop->abandon();
        return protocol::StepResult::kBusy;
      }
    };
}

}  // namespace driftmesh::testing
