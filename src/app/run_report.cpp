#include "app/run_report.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "app/run_files.hpp"
#include "base/atomic_file.hpp"
#include "base/read_file.hpp"
#include "driftmesh/error.hpp"

namespace driftmesh::app {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

bool is_record(const fs::path& path) {
  return path.extension() == ".json" && !path.string().ends_with(kTraceEnding);
}

/// What the page does not show: who is whose neighbor.
bool belongs_to_page(int depth, Json::parse_event_t event, const Json& value) {
  constexpr int kInSubdomains = 3;  // of "cluster"
  return event != Json::parse_event_t::key || depth != kInSubdomains || (value != "neighbors" && value != "borders");
}

/// Of a trace the page shows slices and plans; moves are in the record.
bool belongs_to_timeline(int depth, Json::parse_event_t event, const Json& value) {
  constexpr int kInEvents = 2;
  if (event != Json::parse_event_t::object_end || depth != kInEvents) return true;
  const auto name = value.find("name");
  if (name == value.end() || !name->is_string()) return false;
  const auto& words = name->get_ref<const std::string&>();
  return words == "refine" || words.starts_with("plan:") || words.starts_with("advice:");
}

/// The part of a file that the page shows, as JSON without blanks.
std::string part_of(const fs::path& path, bool (*belongs)(int, Json::parse_event_t, const Json&)) {
  const auto json = Json::parse(read_file(path.string()), belongs, false);
  if (json.is_discarded()) throw InputError({path.string(), 0}, "is not JSON", "name a record that --json wrote");
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

ReportedRun read_run(const fs::path& path) {
  ReportedRun run{path.stem().string(), part_of(path, belongs_to_page), {}};
  if (run.record.find("\"format\":\"driftmesh ") == std::string::npos)
    throw InputError({path.string(), 0}, "is not the record of a run", "name one that `driftmesh run` or --json wrote");
  const fs::path trace = fs::path(path).replace_extension(kTraceEnding);
  if (fs::exists(trace)) run.trace = part_of(trace, belongs_to_timeline);
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

void write_report(const std::string& path, const std::vector<fs::path>& records, const ReportedMesh& mesh) {
  std::vector<ReportedRun> runs;
  runs.reserve(records.size());
  for (const fs::path& record : records) runs.push_back(read_run(record));
  AtomicFile page(path);
  page.write(report_page(runs, mesh));
  page.commit();
}

}  // namespace driftmesh::app
