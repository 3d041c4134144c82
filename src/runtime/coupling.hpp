#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "decompose/decomposition.hpp"
#include "protocol/messages.hpp"
#include "runtime/run_plan.hpp"

namespace driftmesh {

/// How work learns of the points that its neighbors put on common borders. A rank's loop asks for each point, between
/// two slices.
class Coupling {
 public:
  virtual ~Coupling() = default;
  Coupling(const Coupling&) = delete;
  Coupling& operator=(const Coupling&) = delete;

  /// Whom to tell of a point that `from` has put on its border now; nobody, if they learn of it later. What it throws
  /// ends the run.
  [[nodiscard]] virtual std::optional<SubdomainId> to_tell(SubdomainId from, const SplitPoint<GlobalRootId>& split) = 0;
  /// Number of borders on which ranks tell each other of points.
  [[nodiscard]] virtual std::int32_t roots() const = 0;

 protected:
  Coupling() = default;
};

/// The coupling that the plan wants, which must outlive it: neighbors are told of each point at once; in a decoupled
/// run a point on a border is an Error.
[[nodiscard]] std::unique_ptr<Coupling> coupling_of(const RunPlan& plan);

}  // namespace driftmesh
