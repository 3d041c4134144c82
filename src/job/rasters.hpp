#pragma once

#include <map>
#include <string>
#include <vector>

#include "base/bytes.hpp"
#include "driftmesh/mesh.hpp"
#include "geometry/box.hpp"
#include "job/request.hpp"
#include "raster/open_raster.hpp"
#include "sizing/named_raster.hpp"

namespace driftmesh::job {

/// The rasters of a request, for one domain. Each rank opens its own; the threads of a rank share them.
struct Rasters {
  std::map<std::string, std::string> files;  ///< by name, with commas between several
  Stacking stacking;
  std::string projection;    ///< the domain's; see InputFile
  bool from_lonlat = false;  ///< likewise
  std::int32_t threads = 0;  ///< that read them in each process; 0: one for each core
  std::string depth;         ///< the one that the points of the mesh get values of; empty: none
  NamedRasters open;

  /// The raster of depths, open; null: none.
  [[nodiscard]] std::shared_ptr<const Raster> depths() const;

  void write(ByteWriter& writer) const;  ///< without what is open
  [[nodiscard]] static Rasters read(ByteReader& reader);
};

/// None is open yet.
[[nodiscard]] Rasters rasters_of(const Request& request, const std::string& projection, bool from_lonlat = false);

/// Opens all of them around a box, for a domain with these points. Returns warnings: where some of the points lie
/// outside of a raster, or where it has no values. Throws InputError, FileError; see open_raster.
std::vector<std::string> open_all(Rasters& rasters, const Box& box, const std::vector<Point>& points);

/// Gives the points of a mesh, or of a piece, their depths as the only attribute, which is called as the raster is, if
/// one of depths is asked for; and says what their coordinates are.
void set_point_data(const Rasters& rasters, Mesh& mesh);

}  // namespace driftmesh::job
