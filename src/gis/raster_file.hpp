#pragma once

#include <memory>
#include <string>

#include "gis/raster_rows.hpp"

namespace driftmesh {

/// The first band of a raster that GDAL reads, with its scale and offset applied. A raster in a system other than
/// degrees is warped to the zone, bilinearly, if there is one. Throws InputError: for a file that GDAL does not know,
/// one with several rasters or with a frame that is not upright, and for any file where GDAL is not there.
[[nodiscard]] std::unique_ptr<RasterRows> open_raster_file(const std::string& path);

}  // namespace driftmesh
