// Bytes to the readers of all formats that are one file, and of .pvtu: what is accepted must be a mesh whose indices
// and lengths fit.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "driftmesh/error.hpp"
#include "io/mesh_formats.hpp"
#include "io/pvtu_format.hpp"

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
void require_consistent_or_refused(const Parse& parse) {
  try {
    require_consistent(parse());
  } catch (const Error&) {
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  for (const MeshFormat& format : mesh_formats())
    if (format.parse != nullptr) require_consistent_or_refused([&] { return format.parse("fuzz", bytes); });
  try {
    (void)parse_pvtu("fuzz", bytes);
  } catch (const Error&) {
  }
  return 0;
}
