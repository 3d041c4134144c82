#pragma once

#include <string>

#include "job/record.hpp"

namespace driftmesh::app {

using job::RunRecord;

/// The record as readable text: up to 100 columns, a line or a small table for each subject.
[[nodiscard]] std::string summary_text(const RunRecord& run);

/// The histogram alone: 18 lines of 10 degrees, with count, share and bar.
[[nodiscard]] std::string histogram_text(const AngleSummary& shape);

}  // namespace driftmesh::app
