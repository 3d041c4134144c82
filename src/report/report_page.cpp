#include "report/report_page.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <string_view>

#include "base/xml_text.hpp"
#include "driftmesh/error.hpp"
#include "report/page_block.hpp"

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

void add_run(std::string& to, const ReportedRun& run) {
  const std::string timeline = run.timeline.empty() ? "null" : run.timeline;
  const std::string text = "{\"record\":" + run.record + ",\"timeline\":" + timeline + "}";
  add_block(to, "data-run=\"" + escaped(run.name) + "\"", text.data(), text.size());
}

/// An array of the mesh.
template <class Value>
void add_column(std::string& to, const char* name, const char* type, const std::vector<Value>& array,
                const std::string& more = {}) {
  add_array(to, std::string("data-mesh=\"") + name + "\" data-type=\"" + type + "\"" + more, array);
}

void add_mesh(std::string& to, const ReportedMesh& reported) {
  const Mesh& mesh = reported.mesh;
  const Point middle = middle_of(corners_of(mesh.points));
  add_column(to, "points", "Float32", near_the_middle(mesh.points, middle),
             fmt::format(" data-name=\"{}\" data-middle=\"{} {}\"", escaped(reported.name), middle.x, middle.y));
  std::vector<std::int32_t> numbers;
  numbers.reserve(3 * mesh.triangles.size());
  for (const auto& t : mesh.triangles) numbers.insert(numbers.end(), t.begin(), t.end());
  add_column(to, "triangles", "Uint32", numbers);
  if (!mesh.ranks.empty()) add_column(to, "rank", "Int32", mesh.ranks);
  if (!mesh.subdomains.empty()) add_column(to, "subdomain", "Int32", mesh.subdomains);
  if (!mesh.regions.empty())
    add_column(to, "region", "Float32", std::vector<float>(mesh.regions.begin(), mesh.regions.end()));
  if (!reported.sizes.empty()) add_column(to, "sizes", "Float32", reported.sizes);
}

}  // namespace

bool has_report_page() {
  return !page().empty();
}

std::string report_page(const std::vector<ReportedRun>& runs, const ReportedMesh& mesh, const PackedFrames* frames) {
  const std::size_t place = page().find(kPlaceOfData);
  if (place == std::string_view::npos) throw Error("this program was built without the page of reports");
  std::string made(page().substr(0, place));
  for (const ReportedRun& run : runs) add_run(made, run);
  if (!mesh.mesh.triangles.empty()) add_mesh(made, mesh);
  if (frames != nullptr) made += frames->blocks();
  made += page().substr(place + kPlaceOfData.size());
  return made;
}

}  // namespace driftmesh
