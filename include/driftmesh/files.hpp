#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "driftmesh/mesh.hpp"
#include "driftmesh/pslg.hpp"

namespace driftmesh {

/// Reads Triangle's .poly: vertices with attributes and boundary markers, segments, holes, and regions with an
/// attribute and an area bound. A region with one value uses it for both, as Triangle does: the caller's options decide
/// which of the two counts. A .poly with 0 vertices takes them from the .node file of the same stem, and its
/// separators, segments with marker -1000000, are not read: it may be that of a mesh made in subdomains. A path that
/// ends in .node is read as points alone. Geometric faults (duplicates, crossings) are left for repair(). Throws
/// FileError when a file cannot be read and InputError with up to ten messages "file:line: what; next step".
[[nodiscard]] Pslg read_poly(const std::string& path);

/// A domain from a file.
struct InputFile {
  Pslg pslg;
  /// "UTM zone 18N", or "stereographic at 0 90": of coordinates that the file has in degrees, or that it names. Empty:
  /// it is not known, and coordinates are those of the file.
  std::string projection;
  std::vector<std::string> warnings{};  ///< about what the author of the file may not have meant
  bool from_lonlat = false;             ///< the file has longitudes and latitudes
};

/// Reads a domain: GeoJSON (.geojson, .json), by GDAL shapefiles and others that GIS have (.shp, .gpkg, .fgb, .gml,
/// .kml, .gmt), or what read_poly reads. Polygons of GeoJSON and its like are the domain and their holes are holes;
/// lines and points are constraints; properties have markers and regions (docs/file-formats.md). Longitudes and
/// latitudes become meters in the UTM zone of their middle. A mesh (.vtu, .msh, .14 or another that read_mesh reads, of
/// Triangle's files the .ele) stands for its outline (outline.hpp). `layers`: of a file that has several, names with
/// commas between them. Throws FileError for a file that is not there or cannot be read, and InputError: with up to ten
/// messages as read_poly does; naming the feature of what is wrong in a GIS file; for coordinates that are no
/// longitudes and latitudes, or reach too far for a UTM zone; for layers that the file has not, or several of which
/// none is named; and where GDAL is needed and not there.
///
/// \code
/// driftmesh::write_poly(driftmesh::generate("pipe"), "pipe.poly");
/// const driftmesh::InputFile input = driftmesh::read_input("pipe.poly");
/// for (const std::string& warning : input.warnings) std::cerr << warning << '\n';
/// const driftmesh::Mesh mesh = driftmesh::mesh(input.pslg);
/// driftmesh::write_mesh(mesh, "pipe.msh", {.ascii = true});
/// assert(driftmesh::read_mesh("pipe.msh").triangles == mesh.triangles);
/// \endcode
[[nodiscard]] InputFile read_input(const std::string& path, const std::string& layers = "");

/// Whether the file at `path` is read as an input, by read_input, and not as a mesh: GeoJSON and its like, a .poly, or
/// a .node without an .ele next to it.
[[nodiscard]] bool holds_input(const std::string& path);

/// Writes `pslg` as .poly, numbered from pslg.first_number. Numbers are the shortest that read back to the
/// same bits; reading the file gives an equal Pslg. The format has no polygons: an input that has some is repaired
/// first, and hole and region points take their place, so that the file means the same. The file appears only once it
/// is complete. Throws FileError and, with polygons, what repair() throws, or Error if they cover nothing.
void write_poly(const Pslg& pslg, const std::string& path);

/// Optional content of a mesh file.
struct WriteOptions {
  std::vector<Point> holes{};  ///< a point in each hole, for Triangle's .poly; other formats need none
  bool ascii = false;          ///< .msh as text, for programs that read no binary one
  /// Markers of edges that are open sea, for .14, .grd and .gr3. None: those of markers that are called "open".
  std::vector<std::int32_t> open_boundary{};
  /// Open boundaries shorter than this, in units of the mesh, are land there: such as creeks that the frame of a domain
  /// cuts.
  double open_from = 0;
  /// Coordinates in the file, of a mesh that knows its own (Mesh::coordinates): "auto" (longitudes and latitudes on WGS
  /// 84 in .14, .grd and .gr3 if the domain was given in such, otherwise as the mesh has them), "lonlat", "projected"
  /// (as the mesh has them), or a code such as "EPSG:3035", which takes GDAL. Files say what they have; read_mesh takes
  /// them back.
  std::string crs = "auto";
  bool ghost_layer = false;  ///< pieces of .pvtu with a ring of ghost triangles; a whole mesh has none
  /// Is told what of the mesh the format cannot hold, and what its solvers will refuse.
  std::function<void(const std::string&)> warn{};
};

/// Writes the mesh in the format that the extension of `path` names, such as .vtu, .msh or .ele: docs/file-formats.md
/// lists all of them with what they hold; to standard output for "-" (as .vtu), "-.vtu" and the like, if the format is
/// one file. Files appear under their names only when complete. Errors: InputError for an unknown extension, for
/// formats of meshes in pieces, and for names that no file can hold (see Names), FileError.
void write_mesh(const Mesh& mesh, const std::string& path, const WriteOptions& options = {});

/// What reading a mesh may do.
struct ReadOptions {
  bool allow_outside = false;  ///< a .pvtu may name pieces outside of its own folder, and through links that leave it
};

/// Reads a mesh back, from any of these formats but .pmesh, from standard input by the same names, or from the pieces
/// that a .pvtu names. Other coordinates than those in which the mesh was made become these, to some nanometers. A file
/// on disk may be mapped: another program must not shorten it meanwhile. Everything is checked before it is used:
/// indices are in range and counts fit the file. Triangles stay as the file lists them, so that a check sees the actual
/// contents; only if the total area is negative are all of them reversed. Errors: InputError naming file and place,
/// FileError.
[[nodiscard]] Mesh read_mesh(const std::string& path, const ReadOptions& options = {});

}  // namespace driftmesh
