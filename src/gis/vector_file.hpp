#pragma once

#include <string>
#include <vector>

namespace driftmesh {

/// Whether the file is one of polygons and lines that GDAL reads, by its name: .shp, .gpkg, .fgb, .gml, .kml, .gmt.
[[nodiscard]] bool is_vector_file(const std::string& path);

/// The files that are read for it: those beside a shapefile, too, as far as they exist.
[[nodiscard]] std::vector<std::string> vector_files(const std::string& path);

/// Whether GDAL is there.
[[nodiscard]] bool can_read_vectors();

/// What the "crs" of vector_as_geojson names for coordinates in meters that no code of UTM stands for.
inline constexpr const char* kInMeters = "meters";

/// What it names for longitudes and latitudes that were in this system already.
inline constexpr const char* kWgs84 = "EPSG:4326";

/// What it names where the file says nothing.
inline constexpr const char* kUnsaid = "unknown";

/// The features of such a file, or of a .geojson or .json, as the text of GeoJSON, in order, with their fields as
/// properties in lower case. Fields without a value and empty texts are left out. Coordinates in a UTM zone become
/// those of the zone on WGS 84, which a "crs" names by its code; in another projection in meters but Mercator's, and
/// where the system is not known, they remain as they are; all others become longitudes and latitudes on WGS 84, with
/// no "crs", or with that of WGS 84 if they were such: which GDAL also says of a .geojson in a system that it does not
/// know. Changes of datum are as precise as the data that PROJ has. Curves become lines. `layers`: names with
/// commas between them, in the order in which their features come; empty: the only one. Only the file itself is read,
/// with those of vector_files, and what its extension says that it is. Throws InputError, FileError: for a file that
/// cannot be read or takes GDAL that is not there, for layers that do not exist or lie in different systems, and for
/// several layers of which none is named.
[[nodiscard]] std::string vector_as_geojson(const std::string& path, const std::string& layers);

}  // namespace driftmesh
