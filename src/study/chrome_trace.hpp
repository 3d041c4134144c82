#pragma once

#include <string>

#include "cluster/cluster_run.hpp"

namespace driftmesh::study {

inline constexpr double kMicro = 1e6;  ///< traces count microseconds

/// The slices of work of all ranks, what their planners considered, and the moves between them, as a Chrome trace,
/// which https://ui.perfetto.dev opens.
[[nodiscard]] std::string chrome_trace(const ClusterRun& run);

}  // namespace driftmesh::study
