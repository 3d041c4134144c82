#include "job/rasters.hpp"

#include <algorithm>

#include "base/cores.hpp"
#include "driftmesh/id_vector.hpp"
#include "gis/coordinates.hpp"
#include "gis/projection.hpp"
#include "io/vtu_format.hpp"
#include "job/keys.hpp"
#include "pslg/names.hpp"
#include "raster/raster.hpp"

namespace driftmesh::job {
namespace {

std::string warning_of(const std::string& name, const std::string& file, const OpenedRaster& opened,
                       std::size_t points) {
  const auto part = [&](std::size_t count, const char* one, const char* several) {
    return count == 0 ? "" : std::to_string(count) + (count == 1 ? one : several) + file;
  };
  const std::string outside = part(opened.outside, " lies outside of ", " lie outside of "),
                    without = part(opened.without, " has no value in ", " have no value in "),
                    parts = outside + (outside.empty() || without.empty() ? "" : " and ") + without;
  return "raster " + name + ": of " + std::to_string(points) + " points of the domain, " + parts +
         "; the nearest value counts there";
}

}  // namespace

std::shared_ptr<const Raster> Rasters::depths() const {
  const auto found = std::ranges::find(open, depth, &NamedRaster::name);
  return found == open.end() ? nullptr : found->raster;
}

void Rasters::write(ByteWriter& writer) const {
  writer.value(files.size());
  for (const auto& [name, file] : files) {
    writer.text(name);
    writer.text(file);
  }
  writer.value(stacking);
  writer.text(projection);
  writer.value(from_lonlat);
  writer.value(threads);
  writer.text(depth);
}

Rasters Rasters::read(ByteReader& reader) {
  Rasters rasters;
  for (auto left = reader.value<std::size_t>(); left > 0; --left) {
    std::string name = reader.text();
    rasters.files[std::move(name)] = reader.text();
  }
  rasters.stacking = reader.value<Stacking>();
  rasters.projection = reader.text();
  rasters.from_lonlat = reader.value<bool>();
  rasters.threads = reader.value<std::int32_t>();
  rasters.depth = reader.text();
  return rasters;
}

Rasters rasters_of(const Request& request, const std::string& projection, bool from_lonlat) {
  const Stacking stacking{request.input.raster_blend, request.input.raster_order == RasterOrder::kFinest};
  return {request.input.rasters, stacking, projection, from_lonlat, request.run.threads, request.output.depth, {}};
}

std::vector<std::string> open_all(Rasters& rasters, const Box& box, const std::vector<Point>& points) {
  RasterPlace place{.domain = box, .points = points, .projection = projection_named(rasters.projection)};
  place.threads = to_index(threads_or_cores(rasters.threads));
  std::vector<std::string> warnings;
  for (const auto& [name, file] : rasters.files) {
    const OpenedRaster opened = open_rasters(files_in(file), place, rasters.stacking);
    rasters.open.push_back({name, opened.raster});
    if (opened.outside > 0 || opened.without > 0)
      warnings.push_back(warning_of(name, words_of_files(file), opened, points.size()));
  }
  return warnings;
}

void set_point_data(const Rasters& rasters, Mesh& mesh) {
  if (!rasters.projection.empty())
    mesh.coordinates = Coordinates{.projection = rasters.projection, .from_lonlat = rasters.from_lonlat}.text();
  const std::shared_ptr<const Raster> depths = rasters.depths();
  if (!depths) return;
  mesh.attribute_names.clear();
  if (!is_array_on_points(rasters.depth) && fault_of_name(rasters.depth).empty())
    mesh.attribute_names.push_back(rasters.depth);
  mesh.attributes_per_point = 1;
  mesh.attributes.resize(mesh.points.size());
  std::ranges::transform(mesh.points, mesh.attributes.begin(), [&](const Point& p) { return depths->at(p); });
}

}  // namespace driftmesh::job
