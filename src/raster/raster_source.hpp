#pragma once

#include <memory>
#include <string>

#include "gis/raster_rows.hpp"

namespace driftmesh {

/// Opens a raster to be read: an ESRI ASCII grid (.asc) by itself, anything else by GDAL. Throws FileError, and
/// InputError for a file that is damaged or not what its extension says.
[[nodiscard]] std::unique_ptr<RasterRows> open_raster_rows(const std::string& path);

}  // namespace driftmesh
