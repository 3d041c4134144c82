#pragma once

#include <string_view>

namespace driftmesh {

/// Whether coordinates in the system of this name are longitudes and latitudes in degrees from Greenwich, on whatever
/// datum: a name or an address that ends with such a code of the EPSG ("EPSG:4269", "urn:ogc:def:crs:EPSG::4258"), one
/// of the OGC's ("urn:ogc:def:crs:OGC:1.3:CRS84", CRS83, CRS27), or one of Esri's ("GCS_North_American_1983").
[[nodiscard]] bool is_geographic_system(std::string_view name);

/// The same for a code of the EPSG.
[[nodiscard]] bool is_geographic_code(int code);

/// Whether a name that is_geographic_system() does not know may yet be one of WGS 84: "WGS84", "+proj=longlat
/// +datum=WGS84", or its definition.
[[nodiscard]] bool may_be_wgs84(std::string_view name);

/// The number at the end of a name that speaks of the EPSG, or of Esri, which has numbers of its own beyond those of
/// the EPSG; 0: there is none.
[[nodiscard]] int epsg_code_in(std::string_view name);

}  // namespace driftmesh
