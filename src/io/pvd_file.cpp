#include "io/pvd_file.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <system_error>

#include "base/from_chars.hpp"
#include "base/read_file.hpp"
#include "base/xml_text.hpp"
#include "driftmesh/error.hpp"
#include "io/file_beside.hpp"
#include "io/read_checks.hpp"
#include "io/xml_scanner.hpp"

namespace driftmesh {
namespace {

using Path = std::vector<std::string_view>;

PvdMesh mesh_of(const XmlTag& tag, const std::string& file, const ReadOptions& options) {
  PvdMesh mesh;
  const std::string_view digits = tag.attribute("timestep", "0");
  const auto [end, error] = from_chars(digits.data(), digits.data() + digits.size(), mesh.time);
  if (error != std::errc() || end != digits.data() + digits.size() || !std::isfinite(mesh.time))
    throw InputError({file, tag.line}, "needs timestep=\"a number\" in <DataSet>", kDamaged);
  const std::string name = unescaped(std::string(tag.attribute("file")));
  if (name.empty()) throw InputError({file, tag.line}, "has a DataSet without file", kDamaged);
  mesh.path = file_beside(file, tag.line, "mesh", name, options);
  return mesh;
}

}  // namespace

std::vector<PvdMesh> read_pvd(const std::string& path, const ReadOptions& options) {
  const std::string text = read_file(path, kBeginsXml);
  XmlScanner scanner(path, text);
  std::vector<PvdMesh> meshes;
  bool is_pvd = false, is_whole = false;
  for (XmlTag tag; scanner.next(tag);) {
    if (tag.name == "VTKFile" && tag.opens) is_pvd = tag.attribute("type") == "Collection";
    if (tag.name == "VTKFile" && !tag.opens) is_whole = true;
    if (tag.opens && tag.name == "DataSet" && tag.parents == Path{"VTKFile", "Collection"})
      meshes.push_back(mesh_of(tag, path, options));
  }
  if (!is_pvd) throw InputError({path, 0}, "is not of type Collection", "name a .pvd of meshes");
  if (!is_whole) throw InputError({path, 0}, "ends before </VTKFile>", kDamaged);
  if (meshes.empty()) throw InputError({path, 0}, "names no meshes", "name one that the solver has written to");
  std::ranges::stable_sort(meshes, {}, &PvdMesh::time);
  if (const auto same = std::ranges::adjacent_find(meshes, {}, &PvdMesh::time); same != meshes.end())
    throw InputError({path, 0}, "names several parts of one moment, among them " + same->path,
                     "save each moment as one .vtu or .pvtu");
  return meshes;
}

}  // namespace driftmesh
