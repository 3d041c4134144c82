#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "report/report_page.hpp"

namespace driftmesh::study {

/// NAME.trace.json lies beside the record NAME.json of a run.
inline constexpr const char* kTraceEnding = ".trace.json";

/// The records of runs among files and folders; a folder stands for those in it, in the order of their names. Throws
/// InputError for a folder without any.
[[nodiscard]] std::vector<std::filesystem::path> records_of(const std::vector<std::string>& inputs);

/// Writes a page of the runs with these records, a mesh unless it has no triangles, and frames unless null. A trace
/// beside a record is read, too. Throws InputError for what is not the record of a run, Error without
/// has_report_page().
void write_report(const std::string& path, const std::vector<std::filesystem::path>& records, const ReportedMesh& mesh,
                  const PackedFrames* frames = nullptr);

}  // namespace driftmesh::study
