#pragma once

#include <memory>
#include <string>

#include "gis/raster_rows.hpp"

namespace driftmesh {

/// The first band of a raster that GDAL reads, with its scale and offset applied. Values and frame are those of the
/// file; from_plane leads from a UTM zone on WGS 84 to the system that the file names, by PROJ, with its datum. Throws
/// InputError: for a file that is not what its extension says or leads to others (see open_by_gdal), one with several
/// rasters or with a frame that is not upright, and for any file where GDAL is not there.
[[nodiscard]] std::unique_ptr<RasterRows> open_raster_file(const std::string& path);

}  // namespace driftmesh
