#include "study/run_report.hpp"

#include <algorithm>

#include "base/atomic_file.hpp"
#include "base/read_file.hpp"
#include "driftmesh/error.hpp"
#include "study/timeline.hpp"

namespace driftmesh::study {
namespace {

namespace fs = std::filesystem;
using config::Json;

bool is_record(const fs::path& path) {
  return path.extension() == ".json" && !path.string().ends_with(kTraceEnding);
}

std::string text_of(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

/// The part of a record that the page shows, as JSON without blanks: all but who is whose neighbor.
std::string record_of(const fs::path& path) {
  Json json = Json::parse(read_file(path.string()), nullptr, false);
  if (json.is_discarded()) throw InputError({path.string(), 0}, "is not JSON", "name a record that --json wrote");
  if (const Json::json_pointer subdomains("/cluster/subdomains"); json.contains(subdomains))
    for (const char* const about : {"neighbors", "borders"}) json[subdomains].erase(about);
  return text_of(json);
}

ReportedRun read_run(const fs::path& path) {
  ReportedRun run{path.stem().string(), record_of(path), {}};
  if (run.record.find("\"format\":\"driftmesh ") == std::string::npos)
    throw InputError({path.string(), 0}, "is not the record of a run", "name one that `driftmesh run` or --json wrote");
  const fs::path trace = fs::path(path).replace_extension(kTraceEnding);
  if (fs::exists(trace)) run.timeline = text_of(json_of(timeline_of(read_file(trace.string()), trace)));
  return run;
}

}  // namespace

std::vector<fs::path> records_of(const std::vector<std::string>& inputs) {
  std::vector<fs::path> records;
  for (const std::string& input : inputs) {
    if (!fs::is_directory(input)) {
      records.emplace_back(input);
      continue;
    }
    std::vector<fs::path> found;
    for (const fs::directory_entry& entry : fs::directory_iterator(input))
      if (entry.is_regular_file() && is_record(entry.path())) found.push_back(entry.path());
    if (found.empty())
      throw InputError({input, 0}, "has no records of runs", "name a folder that `driftmesh run` has written");
    std::sort(found.begin(), found.end());
    records.insert(records.end(), found.begin(), found.end());
  }
  return records;
}

void write_report(const std::string& path, const std::vector<fs::path>& records, const ReportedMesh& mesh,
                  const PackedFrames* frames) {
  std::vector<ReportedRun> runs;
  runs.reserve(records.size());
  for (const fs::path& record : records) runs.push_back(read_run(record));
  AtomicFile page(path);
  page.write(report_page(runs, mesh, frames));
  page.commit();
}

}  // namespace driftmesh::study
