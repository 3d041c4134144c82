#include "job/input_file.hpp"

#include <algorithm>
#include <cmath>

#include "base/key_error.hpp"
#include "driftmesh/error.hpp"
#include "driftmesh/outline.hpp"
#include "geojson/read_input.hpp"
#include "gis/coordinates.hpp"
#include "io/mesh_file.hpp"

namespace driftmesh {
namespace {

InputFile outline_in(const std::string& path, const std::string& layers) {
  if (!layers.empty())
    throw InputError({path}, "is a mesh, which has no layers", "name layers of a file that has some");
  const Mesh mesh = read_mesh(path);
  const Coordinates coordinates = coordinates_from(mesh.coordinates).value_or(Coordinates{});
  return {outline(mesh, path), coordinates.projection, {}, coordinates.from_lonlat};
}

/// Whether a grid could be in degrees, as many are, though the file does not say so.
bool could_be_degrees(const std::string& path, const Pslg& pslg) {
  return is_mesh_file(path) && format_of(path).is_grid &&
         std::ranges::all_of(pslg.points, [](const Point& p) { return std::abs(p.x) <= 360 && std::abs(p.y) <= 90; });
}

InputFile read_as_is(const std::string& path, const std::string& layers, const std::string& projection) {
  return is_mesh_file(path) ? outline_in(path, layers) : read_geometry(path, layers, projection);
}

}  // namespace

InputFile job::read_domain_file(const std::string& path, const Request::Input& asked) {
  InputFile input = read_as_is(path, asked.layers, asked.projection);
  if (asked.degrees && !input.projection.empty() && !input.from_lonlat)
    throw KeyError("input.degrees", "is set, but " + path + " is in meters of " + input.projection, "leave it out");
  if (asked.degrees && input.projection.empty())
    project_degrees(input, asked.projection, path);
  else if (input.projection.empty() && could_be_degrees(path, input.pslg))
    input.warnings.push_back(path +
                             " has coordinates that look like longitudes and latitudes, but are taken for those of a "
                             "plane; if they are degrees, say so (degrees)");
  return input;
}

InputFile read_input(const std::string& path, const std::string& layers) {
  return read_as_is(path, layers, "");
}

std::vector<std::string> input_files(const std::string& path) {
  return is_mesh_file(path) ? files_to_read(path) : geometry_files(path);
}

}  // namespace driftmesh
