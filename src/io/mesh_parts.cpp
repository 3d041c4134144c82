#include "io/mesh_parts.hpp"

#include <algorithm>

#include "io/boundary_types.hpp"
#include "mesh/mesh_edges.hpp"

namespace driftmesh {
namespace {

/// `words` if the mesh has such a thing.
std::string if_any(bool any, const char* words) {
  return any ? words : "";
}

std::string inner_segments(const Mesh& mesh) {
  const std::size_t count = mesh.edges.size() - boundary_edges(mesh).size();
  return count == 0 ? "" : std::to_string(count) + " segments inside of the domain";
}

std::string boundary_types(const Mesh& mesh) {
  const auto types = count_types(mesh);
  return types.empty() ? "" : "types of boundaries, of which markers remain: " + list_of_types(types);
}

std::string weirs(const Mesh& mesh) {
  auto types = count_types(mesh);
  std::erase_if(types, [](const auto& count) { return !weir_columns(count.first); });
  return mesh.weirs.empty() ? "" : "the heights and coefficients of weirs: " + list_of_types(types);
}

struct Loss {
  MeshParts parts;                         // lost if none of them is kept
  std::string (*words)(const Mesh& mesh);  // empty if the mesh has nothing of it
};

const Loss kLosses[] = {
    {kFirstAttribute,
     [](const Mesh& mesh) { return if_any(mesh.attributes_per_point > 0, "the first attribute of points"); }},
    {kOtherAttributes,
     [](const Mesh& mesh) { return if_any(mesh.attributes_per_point > 1, "the other attributes of points"); }},
    {kMarkers | kBoundaryTypes,
     [](const Mesh& mesh) { return if_any(!mesh.edges.empty(), "segments of the boundary"); }},
    {kInnerSegments, inner_segments},
    {kRegions, [](const Mesh& mesh) { return if_any(!mesh.regions.empty(), "regions"); }},
    {kRegionNames, [](const Mesh& mesh) { return if_any(!mesh.names.regions.empty(), "names of regions"); }},
    {kMarkerNames,
     [](const Mesh& mesh) {
       const auto is_type = [](const auto& name) { return type_named(name.second).has_value(); };
       return if_any(!std::ranges::all_of(mesh.names.markers, is_type), "names of markers");
     }},
    {kBoundaryTypes, boundary_types},
    {kWeirs, weirs}};

}  // namespace

std::string lost_parts(const Mesh& mesh, MeshParts kept) {
  std::string list;
  for (const Loss& loss : kLosses) {
    if ((kept & loss.parts) != 0) continue;
    const std::string words = loss.words(mesh);
    if (!words.empty()) list += (list.empty() ? "" : "; ") + words;
  }
  return list;
}

}  // namespace driftmesh
