#include "io/other_coordinates.hpp"

#include <algorithm>

#include "driftmesh/error.hpp"
#include "gis/coordinates.hpp"
#include "io/mesh_file.hpp"
#include "io/read_checks.hpp"

namespace driftmesh {

std::string coordinates_wanted(const Mesh& mesh, const std::string& path, const WriteOptions& options) {
  const auto own = coordinates_from(mesh.coordinates);
  if (options.crs.empty() || options.crs == kByFormat)
    return own && own->from_lonlat && format_of(path).is_grid ? kLonLat : "";
  if (options.crs == kProjected) return "";
  if (!own)
    throw InputError({path}, "cannot be in " + options.crs + ": it is not known where on the globe the mesh is",
                     "mesh a domain in degrees or in a UTM zone, or write it as it is");
  return options.crs;
}

void change_coordinates(Mesh& mesh, const std::string& wanted, const std::string& path) {
  auto coordinates = coordinates_from(mesh.coordinates);
  if (wanted.empty() || !coordinates) return;
  const auto place = from_plane(coordinates->projection, wanted, path);
  std::ranges::transform(mesh.points, mesh.points.begin(), place);
  coordinates->in = wanted;
  mesh.coordinates = coordinates->text();
}

void return_to_plane(Mesh& mesh, const std::string& path) {
  auto coordinates = coordinates_from(mesh.coordinates);
  if (!coordinates) return mesh.coordinates.clear();
  if (coordinates->in.empty()) return;
  const auto place = to_plane(coordinates->projection, coordinates->in, path);
  std::ranges::transform(mesh.points, mesh.points.begin(), place);
  make_counterclockwise(mesh);  // areas of longitudes mean nothing where these jump
  coordinates->in.clear();
  mesh.coordinates = coordinates->text();
}

}  // namespace driftmesh
