#pragma once

#include <string>

#include "gis/gdal_functions.hpp"

namespace driftmesh {

#ifdef DRIFTMESH_GDAL_LIBRARY

/// Whether the file is a raster that is put together from others, by its name: .vrt.
[[nodiscard]] bool is_mosaic_file(const std::string& path);

/// Throws InputError unless a .vrt is a mosaic as gdalbuildvrt makes it of GeoTIFFs in its own folder or below it. GDAL
/// knows far more such files: of other folders and of servers, as the output of commands, and as values that code
/// computes.
void require_plain_mosaic(const GdalFunctions& gdal, const std::string& path);

#endif

}  // namespace driftmesh
