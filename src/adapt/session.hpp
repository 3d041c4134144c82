#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "adapt/fields.hpp"
#include "adapt/fit_lengths.hpp"
#include "adapt/generation.hpp"
#include "adapt/regenerate.hpp"
#include "driftmesh/adaptive.hpp"
#include "driftmesh/pslg.hpp"
#include "runtime/run_plan.hpp"

namespace driftmesh::adapt {

/// The mesh that a session begins with.
struct Start {
  RunPlan plan;  ///< without a size field
  Pslg pslg;     ///< repaired
  IdVector<SubdomainId, SubdomainMesh> parts;
  LengthsOfParts lengths;  ///< by which they were made, at their vertices; empty: none were asked for
};

/// A mesh that is refined and coarsened from one generation to the next, by threads of this process. See AdaptiveMesh.
class Session {
 public:
  /// `finish`: adds to each new mesh what only the caller knows.
  Session(Start start, const AdaptiveOptions& options, std::function<void(Mesh&)> finish);

  [[nodiscard]] const Generation& present() const { return present_; }
  [[nodiscard]] const Mesh& mesh() const { return present_.piece.mesh; }
  [[nodiscard]] const Pslg& pslg() const { return pslg_; }
  [[nodiscard]] const AdaptiveOptions& options() const { return options_; }
  [[nodiscard]] const AdaptReport& report() const { return report_; }
  [[nodiscard]] const std::vector<std::int32_t>& stayed_points() const { return stayed_points_; }
  [[nodiscard]] const std::vector<std::int32_t>& stayed_triangles() const { return stayed_triangles_; }

  /// Makes the next generation. If anything throws, everything stays as it is.
  void adapt(std::span<const double> lengths, std::int32_t threads, const Hooks& hooks);
  void adapt(const SizeField& size, std::int32_t threads, const Hooks& hooks);

  void attach(const std::string& name, std::vector<double> values, FieldPlace place, Transfer how);
  void detach(const std::string& name);
  [[nodiscard]] std::span<double> field(const std::string& name);

 private:
  void advance(const std::function<Wanted()>& want, std::int32_t threads, const Hooks& hooks);
  [[nodiscard]] Field& find_field(const std::string& name);

  RunPlan plan_;
  Pslg pslg_;
  AdaptiveOptions options_;
  std::function<void(Mesh&)> finish_;
  Generation present_;
  AdaptReport report_;
  std::vector<std::int32_t> stayed_points_, stayed_triangles_;
  Fields fields_;
};

}  // namespace driftmesh::adapt
