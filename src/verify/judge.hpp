#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "driftmesh/mesh.hpp"
#include "verify/chains.hpp"
#include "verify/findings.hpp"
#include "verify/quality.hpp"
#include "verify/room.hpp"
#include "verify/step_check.hpp"

namespace driftmesh {

/// Decides whether triangles that miss a bound may do so: see ExceptionReason. What it has to know of the mesh is near
/// its subsegments.
class Judge {
 public:
  /// All subsegments and the triangles beside them are in `mesh`, in which points have ascending numbers. The arguments
  /// must outlive the object. `step`: null if there is no time step.
  Judge(const Mesh& mesh, const Chains& chains, double min_angle, std::size_t max_listed, const StepCheck* step)
      : mesh_(mesh), chains_(chains), min_angle_(min_angle), max_listed_(max_listed), step_(step) {}

  /// Adds a suspect to the exceptions or to the findings.
  void judge(const Suspect& suspect, Quality& quality, Findings& findings);

 private:
  void judge_angle(const Suspect& suspect, Quality& quality, Findings& findings);
  /// The vertex of the mesh; kNone: such a point is no end of a subsegment.
  [[nodiscard]] std::int32_t vertex_of(std::int64_t number) const;
  [[nodiscard]] bool is_subsegment(std::int32_t u, std::int32_t v) const;
  [[nodiscard]] bool is_seditious(std::int32_t p, std::int32_t q) const;
  const Room& room();
  template <class Describe>
  void except(ExceptionReason reason, Quality& quality, const Describe& describe) const;

  const Mesh& mesh_;
  const Chains& chains_;
  double min_angle_;
  std::size_t max_listed_;
  const StepCheck* step_;
  std::optional<Room> room_;
};

}  // namespace driftmesh
