// Bytes to the readers of VTU, PVTU, .msh, .14 and .su2: what is accepted must be a mesh whose indices and lengths fit.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "driftmesh/error.hpp"
#include "io/fort14_format.hpp"
#include "io/msh_format.hpp"
#include "io/pvtu_format.hpp"
#include "io/su2_format.hpp"
#include "io/vtu_format.hpp"

namespace {

using namespace driftmesh;

void require(bool condition) {
  if (!condition) std::abort();
}

void require_consistent(const Mesh& mesh) {
  const auto exists = [&mesh](std::int32_t v) { return v >= 0 && static_cast<std::size_t>(v) < mesh.points.size(); };
  for (const auto& triangle : mesh.triangles)
    for (const std::int32_t vertex : triangle) require(exists(vertex));
  for (const auto& edge : mesh.edges) require(exists(edge.a) && exists(edge.b));
  require(mesh.regions.empty() || mesh.regions.size() == mesh.triangles.size());
  require(mesh.point_markers.empty() || mesh.point_markers.size() == mesh.points.size());
  require(mesh.numbers.empty() || mesh.numbers.size() == mesh.points.size());
  require(mesh.subdomains.empty() || mesh.subdomains.size() == mesh.triangles.size());
  require(mesh.ranks.empty() || mesh.ranks.size() == mesh.triangles.size());
  require(mesh.attributes.size() == mesh.points.size() * static_cast<std::size_t>(mesh.attributes_per_point));
}

template <class Parse>
void parse_and_check(Parse parse, std::string_view bytes) {
  try {
    require_consistent(parse("fuzz", bytes));
  } catch (const Error&) {
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  parse_and_check([](const auto& file, auto text) { return parse_vtu(file, text); }, bytes);
  parse_and_check(parse_msh, bytes);
  parse_and_check(parse_fort14, bytes);
  parse_and_check(parse_su2, bytes);
  try {
    (void)parse_pvtu("fuzz", bytes);
  } catch (const Error&) {
  }
  return 0;
}
