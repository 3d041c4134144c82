#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>

#include "driftmesh/point.hpp"
#include "gis/projection.hpp"

namespace driftmesh {

/// Where the values of a raster are: at the points first + (i dx, j dy) for 0 <= i < columns, 0 <= j < rows.
struct RasterFrame {
  std::int64_t columns = 0, rows = 0;
  Point first{};          ///< the lower left one
  double dx = 0, dy = 0;  ///< > 0
};

/// From places in one system of coordinates to places in another.
using PlaceFunction = std::function<Point(const Point&)>;

/// The coordinates of a domain that is made from a raster.
struct DomainSystem {
  bool in_degrees = false;      ///< longitudes and latitudes; otherwise coordinates in a plane
  std::string projection{};     ///< "UTM zone 18N" if they are in a zone on WGS 84; empty: not known, or degrees
  PlaceFunction from_raster{};  ///< from the raster's coordinates; null: they are the same
};

/// A raster in a file, to be read once from the top to the bottom.
class RasterRows {
 public:
  virtual ~RasterRows() = default;
  [[nodiscard]] virtual const RasterFrame& frame() const = 0;
  /// From places in a plane to the raster's coordinates; null: they are the same. A file that does not name its system
  /// has longitudes and latitudes if all its coordinates could be some, and is in the plane otherwise.
  [[nodiscard]] virtual PlaceFunction from_plane(const Projection& projection) const;
  /// The inverse.
  [[nodiscard]] virtual PlaceFunction to_plane(const Projection& projection) const;
  /// Whether the coordinates are Mercator's, whose meters are none (see Mercator).
  [[nodiscard]] virtual bool in_mercator() const { return false; }
  /// The coordinates that a domain made from the raster should have: those of the raster in degrees, in a UTM zone, or
  /// in another plane with meters; otherwise longitudes and latitudes on WGS 84. A file that does not name its system
  /// is judged as from_plane() does.
  [[nodiscard]] virtual DomainSystem domain_system() const;
  /// Values of row `j` from column `first` on, NaN where there are none. Rows are asked for in descending order, each
  /// at most once. Throws InputError.
  virtual void read(std::int64_t j, std::int64_t first, std::span<float> values) = 0;
  /// After the last row that is needed: throws InputError where the rest of the file is damaged, as far as that is
  /// seen.
  virtual void finish() {}
};

}  // namespace driftmesh
