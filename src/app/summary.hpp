#pragma once

#include <string>

#include "job/record.hpp"

namespace driftmesh::app {

using job::RunRecord;

/// The record as readable text: up to 100 columns, a line or a small table for each subject.
[[nodiscard]] std::string summary_text(const RunRecord& run);

/// The histogram alone: 18 lines of 10 degrees, with count, share and bar.
[[nodiscard]] std::string histogram_text(const AngleSummary& shape);

/// The record as JSON, for programs; docs/file-formats.md describes it. Its "version" increases when a field changes
/// its meaning or is removed.
[[nodiscard]] std::string summary_json(const RunRecord& run);

}  // namespace driftmesh::app
