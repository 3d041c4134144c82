#include "bench/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <iterator>
#include <nlohmann/json.hpp>
#include <thread>

namespace driftmesh::bench {
namespace {

double median(const Measurement& m, double MeshRun::*value) {
  std::vector<double> values;
  for (const MeshRun& run : m.runs) values.push_back(run.*value);
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

bool refined(const Measurement& m) {
  return m.area_bound > 0;
}

struct Column {
  std::string heading;
  std::function<std::string(const Measurement&)> cell;
};

std::vector<Column> common_columns() {
  return {{"input", [](const Measurement& m) { return m.model; }},
          {"mesher", [](const Measurement& m) { return m.mesher; }},
          {"triangles", [](const Measurement& m) { return fmt::format("{}", m.runs.front().triangles); }},
          {"CDT s", [](const Measurement& m) { return fmt::format("{:.3f}", median_cdt(m)); }}};
}

std::vector<Column> refinement_columns() {
  return {
      {"refinement s", [](const Measurement& m) { return fmt::format("{:.3f}", median_refine(m)); }},
      {"million triangles/s", [](const Measurement& m) { return fmt::format("{:.2f}", rate(m)); }},
      {"peak bytes/triangle", [](const Measurement& m) { return fmt::format("{:.1f}", bytes_per_triangle(m)); }},
      {"smallest angle", [](const Measurement& m) { return fmt::format("{:.2f}", m.runs.front().smallest_angle); }}};
}

/// The column that compares meshers or sizes, depending on the suite.
std::vector<Column> comparison_columns(const std::string& suite, const std::vector<Measurement>& all) {
  if (suite == "cgal")
    return {{"times CGAL", [&all](const Measurement& m) {
               const auto cgal = std::find_if(all.begin(), all.end(), [&](const Measurement& other) {
                 return other.suite == m.suite && other.model == m.model && other.mesher == "CGAL";
               });
               return fmt::format("{:.1f}", rate(m) / rate(*cgal));
             }}};
  if (suite == "growth")
    return {{"time/triangle against the first", [&all](const Measurement& m) {
               const auto first = std::find_if(all.begin(), all.end(),
                                               [&](const Measurement& other) { return other.suite == m.suite; });
               return fmt::format("{:.3f}", rate(*first) / rate(m));
             }}};
  return {};
}

void append(std::vector<Column>& columns, const std::vector<Column>& more) {
  columns.insert(columns.end(), more.begin(), more.end());
}

std::string row_of(const std::vector<Column>& columns, const std::function<std::string(const Column&)>& cell) {
  std::string row = "|";
  for (const Column& column : columns) row += fmt::format(" {} |", cell(column));
  return row + "\n";
}

/// The value after "key  :" in a file such as /proc/cpuinfo, or "unknown".
std::string value_in(const char* file, const std::string& key) {
  std::ifstream lines(file);
  for (std::string line; std::getline(lines, line);)
    if (line.starts_with(key)) return line.substr(std::min(line.find(':') + 2, line.size()));
  return "unknown";
}

nlohmann::json to_json(const MeshRun& run) {
  return {{"vertices", run.vertices},
          {"triangles", run.triangles},
          {"smallest_angle_degrees", run.smallest_angle},
          {"largest_area", run.largest_area},
          {"seconds_cdt", run.seconds_cdt},
          {"seconds_refine", run.seconds_refine},
          {"peak_bytes", run.peak_bytes}};
}

}  // namespace

double median_cdt(const Measurement& m) {
  return median(m, &MeshRun::seconds_cdt);
}
double median_refine(const Measurement& m) {
  return median(m, &MeshRun::seconds_refine);
}

double rate(const Measurement& m) {
  return 1e-6 * static_cast<double>(m.runs.front().triangles) / median_refine(m);
}

double bytes_per_triangle(const Measurement& m) {
  double most = 0;
  for (const MeshRun& run : m.runs)
    most = std::max(most, static_cast<double>(run.peak_bytes) / static_cast<double>(run.triangles));
  return most;
}

std::string table_of(const std::string& suite, const std::vector<Measurement>& all) {
  std::vector<Measurement> mine;
  std::copy_if(all.begin(), all.end(), std::back_inserter(mine),
               [&](const Measurement& m) { return m.suite == suite; });
  if (mine.empty()) return "";
  std::vector<Column> columns = common_columns();
  if (refined(mine.front())) append(columns, refinement_columns());
  append(columns, comparison_columns(suite, all));
  std::string table = fmt::format("### {}\n\n", suite);
  table += row_of(columns, [](const Column& column) { return column.heading; });
  table += row_of(columns, [](const Column&) { return std::string("---"); });
  for (const Measurement& m : mine) table += row_of(columns, [&](const Column& column) { return column.cell(m); });
  return table;
}

std::string machine() {
  std::string load = "unknown";
  std::ifstream("/proc/loadavg") >> load;
  return fmt::format("{}, {} cores, load {}, compiled by {}", value_in("/proc/cpuinfo", "model name"),
                     std::thread::hardware_concurrency(), load, "GCC-compatible " __VERSION__);
}

nlohmann::json to_json(const std::vector<Measurement>& measurements) {
  nlohmann::json list = nlohmann::json::array();
  for (const Measurement& m : measurements) {
    nlohmann::json runs = nlohmann::json::array();
    for (const MeshRun& run : m.runs) runs.push_back(to_json(run));
    list.push_back({{"suite", m.suite},
                    {"model", m.model},
                    {"mesher", m.mesher},
                    {"area_bound", m.area_bound},
                    {"runs", std::move(runs)}});
  }
  return {{"machine", machine()}, {"measurements", std::move(list)}};
}

}  // namespace driftmesh::bench
