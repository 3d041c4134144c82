#include "job/input_file.hpp"

#include "driftmesh/error.hpp"
#include "driftmesh/outline.hpp"
#include "geojson/read_input.hpp"
#include "io/mesh_file.hpp"

namespace driftmesh {

InputFile read_input(const std::string& path, const std::string& layers) {
  if (!is_mesh_file(path)) return read_geometry(path, layers);
  if (!layers.empty())
    throw InputError({path}, "is a mesh, which has no layers", "name layers of a file that has some");
  return {outline(read_mesh(path), path), {}};
}

std::vector<std::string> input_files(const std::string& path) {
  return is_mesh_file(path) ? files_to_read(path) : geometry_files(path);
}

}  // namespace driftmesh
