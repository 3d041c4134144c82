#pragma once

#include <memory>

#include "experiment/experiment.hpp"
#include "pslg/pslg.hpp"
#include "pslg/repair_report.hpp"
#include "runtime/run_plan.hpp"
#include "sizing/make_size_field.hpp"

namespace driftmesh::experiment {

/// A run, ready to begin.
struct Prepared {
  Pslg pslg;  ///< repaired
  RepairReport repairs;
  std::unique_ptr<SizeField> size;  ///< or null
  RunPlan plan;                     ///< refers to `size`
  std::int32_t acute_corners = 0;
  double forecast = 0;  ///< of triangles
};

[[nodiscard]] SizingOptions sizing_of(const Experiment& experiment);

/// The name of the domain: a file, or what is generated.
[[nodiscard]] std::string input_name(const Experiment& experiment);

/// Reads or generates the domain, cuts it up and maps it to so many ranks with these speeds. Throws Error for what
/// input and bounds do not allow, FileError.
[[nodiscard]] Prepared prepare(const Experiment& experiment, const std::vector<double>& speeds);

}  // namespace driftmesh::experiment
