#pragma once

#include <string>

#include "driftmesh/files.hpp"
#include "job/request.hpp"

namespace driftmesh::job {

/// A raster and a level in it.
struct Contour {
  std::string raster;  ///< its name
  double level = 0;
  bool below = false;  ///< whether the domain is where the raster is below the level
};

/// Reads "depth=0", "depth>0" or "elevation<0". Throws KeyError for what is none of these, names no raster of the
/// request, or has limits or points with missing numbers.
[[nodiscard]] Contour contour_of(const Request::Input& input);

/// The files of the raster, for messages.
[[nodiscard]] std::string contour_files(const Request::Input& input);

/// The domain that the request makes from a raster (see LevelOutline), as if a GeoJSON had it: the largest part, or
/// those with the seeds, with sides of the raster or of the limits as open boundaries. Throws InputError where nothing
/// is beyond the level, or not at a seed, and as open_mosaic and input_of do.
[[nodiscard]] InputFile contour_input(const Request::Input& input);

}  // namespace driftmesh::job
