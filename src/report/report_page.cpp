#include "report/report_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <string_view>

#include "base/xml_text.hpp"
#include "driftmesh/error.hpp"
#include "report/packed_text.hpp"

extern "C" {
// NOLINTNEXTLINE(readability-identifier-naming): assembly has these names
extern const char driftmesh_report_page[], driftmesh_report_page_end[];
}

namespace driftmesh {
namespace {

constexpr std::string_view kPlaceOfData = "<!-- data -->";

std::string_view page() {
  return {driftmesh_report_page, static_cast<std::size_t>(driftmesh_report_page_end - driftmesh_report_page)};
}

void add_block(std::string& to, const std::string& attributes, const void* bytes, std::size_t count) {
  to += "<script type=\"text/plain\" " + attributes + ">";
  to += packed_text(bytes, count);
  to += "</script>\n";
}

void add_run(std::string& to, const ReportedRun& run) {
  const std::string timeline = run.timeline.empty() ? "null" : run.timeline;
  const std::string text = "{\"record\":" + run.record + ",\"timeline\":" + timeline + "}";
  add_block(to, "data-run=\"" + escaped(run.name) + "\"", text.data(), text.size());
}

template <class Value>
void add_array(std::string& to, const char* name, const char* type, const std::vector<Value>& array,
               const std::string& more = {}) {
  add_block(to, std::string("data-mesh=\"") + name + "\" data-type=\"" + type + "\"" + more, array.data(),
            array.size() * sizeof(Value));
}

Point middle_of(const std::vector<Point>& points) {
  Point low = points.front(), high = low;
  for (const Point& p : points) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  return {low.x + (high.x - low.x) / 2, low.y + (high.y - low.y) / 2};
}

/// Seen from the middle of the mesh: a float has seven digits.
std::vector<float> near_the_middle(const std::vector<Point>& points, const Point& middle) {
  std::vector<float> near;
  near.reserve(2 * points.size());
  for (const Point& p : points) {
    near.push_back(static_cast<float>(p.x - middle.x));
    near.push_back(static_cast<float>(p.y - middle.y));
  }
  return near;
}

void add_mesh(std::string& to, const ReportedMesh& reported) {
  const Mesh& mesh = reported.mesh;
  const Point middle = middle_of(mesh.points);
  add_array(to, "points", "Float32", near_the_middle(mesh.points, middle),
            fmt::format(" data-name=\"{}\" data-middle=\"{} {}\"", escaped(reported.name), middle.x, middle.y));
  std::vector<std::int32_t> numbers;
  numbers.reserve(3 * mesh.triangles.size());
  for (const auto& t : mesh.triangles) numbers.insert(numbers.end(), t.begin(), t.end());
  add_array(to, "triangles", "Uint32", numbers);
  if (!mesh.ranks.empty()) add_array(to, "rank", "Int32", mesh.ranks);
  if (!mesh.subdomains.empty()) add_array(to, "subdomain", "Int32", mesh.subdomains);
  if (!mesh.regions.empty())
    add_array(to, "region", "Float32", std::vector<float>(mesh.regions.begin(), mesh.regions.end()));
  if (!reported.sizes.empty()) add_array(to, "sizes", "Float32", reported.sizes);
}

}  // namespace

bool has_report_page() {
  return !page().empty();
}

std::string report_page(const std::vector<ReportedRun>& runs, const ReportedMesh& mesh) {
  const std::size_t place = page().find(kPlaceOfData);
  if (place == std::string_view::npos) throw Error("this program was built without the page of reports");
  std::string made(page().substr(0, place));
  for (const ReportedRun& run : runs) add_run(made, run);
  if (!mesh.mesh.triangles.empty()) add_mesh(made, mesh);
  made += page().substr(place + kPlaceOfData.size());
  return made;
}

}  // namespace driftmesh
