#pragma once

#include <string>

#include "job/record.hpp"

namespace driftmesh::study {

using job::RunRecord;

/// The record as JSON, for programs; docs/file-formats.md describes it. Its "version" increases when a field changes
/// its meaning or is removed.
[[nodiscard]] std::string run_json(const RunRecord& run);

}  // namespace driftmesh::study
