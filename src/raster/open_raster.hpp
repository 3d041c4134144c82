#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "driftmesh/point.hpp"
#include "gis/projection.hpp"
#include "raster/raster.hpp"

namespace driftmesh {

/// What a raster is opened for.
struct RasterPlace {
  Box domain{};                            ///< around the domain
  std::span<const Point> points{};         ///< points of the domain, which are counted below
  std::optional<Projection> projection{};  ///< their plane; absent: it is not known, and is that of the raster
  std::size_t threads = 1;                 ///< that may read several files at once
};

/// A raster, and how well it covers the domain.
struct OpenedRaster {
  std::shared_ptr<const Raster> raster;
  std::size_t outside = 0;  ///< points of the domain that lie outside of the raster
  std::size_t without = 0;  ///< others where it has no value
};

/// Reads a raster around the box of a domain: an ESRI ASCII grid (.asc) by itself, anything else by GDAL. The file is
/// read once, row by row; what is needed of it is kept in tiles, in memory or, where it is large, on disk (see
/// MappedRoom).
/// - Where the raster has no value, that of the nearest point which has one counts, of all within an eighth of the
///   domain's size around it.
/// - A raster in other coordinates than the domain is resampled bilinearly (see resample); values are kept in single
///   precision.
/// Errors: FileError, and InputError for a damaged file, one that does not overlap the domain, and one without values
/// there.
[[nodiscard]] OpenedRaster open_raster(const std::string& path, const RasterPlace& place);

/// How several rasters become one function.
struct Stacking {
  double blend = 0;  ///< the width of seams, in the units of the domain; at least a spacing of the upper raster
  bool finest_first = false;  ///< in the order of their spacings, not as given
};

/// Several rasters as one: the first on top, its gaps and what is outside of it filled from the next ones, with seams
/// where the share of the upper one rises from 0 at its gaps and sides to 1 (see RasterStack). What none has gets the
/// nearest value of the last one. Neighbors in the order that are on one grid, as tiles are, are one raster without
/// seams. Threads read such tiles at once, each only around the domain, if they are GeoTIFFs or ESRI ASCII grids; other
/// files are read one after the other. Those that do not overlap the domain are left out. Errors as open_raster: it is
/// enough that one has values in the domain.
[[nodiscard]] OpenedRaster open_rasters(const std::vector<std::string>& paths, const RasterPlace& place,
                                        const Stacking& how);

}  // namespace driftmesh
