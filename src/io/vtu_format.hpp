#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "driftmesh/mesh.hpp"
#include "io/file_sink.hpp"
#include "io/triangle_data.hpp"

namespace driftmesh {

/// The data arrays of a file in addition to the grid itself, the same for all pieces of a .pvtu.
struct VtuArrays {
  bool point_markers = false;
  std::int32_t attributes = 0;  ///< components
  bool numbers = false;
  bool cell_markers = false;
  bool regions = false;
  bool subdomains = false;
  bool ranks = false;
  bool ghosts = false;       ///< on points
  bool ghost_cells = false;  ///< on triangles of other pieces
  /// Empty: attributes are the components of one array; otherwise each has an array with its name.
  std::vector<std::string> attribute_names{};
};
/// The arrays for which the mesh has values.
[[nodiscard]] VtuArrays arrays_of(const Mesh& mesh);

/// Whether files have something of this name among the values of points, so that no attribute can have it.
[[nodiscard]] inline bool is_array_on_points(std::string_view name) {
  return name == "marker" || name == "attribute" || name == "global_number" || name == "vtkGhostType";
}

/// Calls visit(a null pointer of the type, name, components) for each array on points, in the order of the file.
template <class Visit>
void for_each_point_array(const VtuArrays& arrays, const Visit& visit) {
  constexpr const std::uint8_t* kUInt8 = nullptr;
  constexpr const std::int32_t* kInt32 = nullptr;
  constexpr const std::int64_t* kInt64 = nullptr;
  constexpr const double* kFloat64 = nullptr;
  if (arrays.point_markers) visit(kInt32, "marker", 1);
  if (arrays.attributes > 0 && arrays.attribute_names.empty()) visit(kFloat64, "attribute", arrays.attributes);
  for (const std::string& name : arrays.attribute_names) visit(kFloat64, name, 1);
  if (arrays.numbers) visit(kInt64, "global_number", 1);
  if (arrays.ghosts) visit(kUInt8, "vtkGhostType", 1);
}
/// The same, visit(pointer, name), for arrays on cells.
template <class Visit>
void for_each_cell_array(const VtuArrays& arrays, const Visit& visit) {
  constexpr const std::uint8_t* kUInt8 = nullptr;
  constexpr const std::int32_t* kInt32 = nullptr;
  constexpr const double* kFloat64 = nullptr;
  if (arrays.cell_markers) visit(kInt32, "marker");
  if (arrays.regions) visit(kFloat64, "region");
  if (arrays.subdomains) visit(kInt32, "subdomain");
  if (arrays.ranks) visit(kInt32, "rank");
  if (arrays.ghost_cells) visit(kUInt8, "vtkGhostType");
}

// Names of markers, regions and attributes are arrays of the field data, which are called so and have two components:
// the number that has the name (attributes count from 0), and the dimension of what has it. So is Mesh::coordinates, of
// number 0. These are the names of the first component.
inline constexpr const char* kMarkerOfName = "marker";
inline constexpr const char* kRegionOfName = "region";
inline constexpr const char* kAttributeOfName = "attribute";
inline constexpr const char* kCoordinatesOfName = "coordinates";

/// VTK's numbers of kinds of cells.
inline constexpr std::uint8_t kVtkLine = 3, kVtkTriangle = 5;

/// VTK's name of the type.
template <class T>
[[nodiscard]] constexpr const char* vtk_type_name() {
  if constexpr (std::is_same_v<T, std::uint8_t>) return "UInt8";
  if constexpr (std::is_same_v<T, std::int32_t>) return "Int32";
  if constexpr (std::is_same_v<T, std::int64_t>) return "Int64";
  if constexpr (std::is_same_v<T, double>) return "Float64";
}

/// One VTK unstructured grid: the triangles, then the constrained edges as line cells, as raw appended binary data.
/// Point data "marker", "attribute" (or the attributes' names) and "global_number"; cell data "marker" (0 on
/// triangles), "region", "subdomain" and "rank" (on a line, those of an adjacent triangle); each only if the mesh has
/// it.
void write_vtu(const Mesh& mesh, const std::string& path);
/// The same with data at triangles; a line has those of an adjacent triangle.
void write_vtu_with_data(const Mesh& mesh, const TriangleData& data, const std::string& path);
/// What VTK calls a point or a cell that another piece of the mesh counts, and so leaves out of sums and counts.
inline constexpr std::uint8_t kDuplicate = 1;

/// What of a piece other pieces count.
struct VtuGhosts {
  std::vector<std::uint8_t> points{};  ///< with VtuArrays::ghosts: for each point 0 or kDuplicate
  /// With VtuArrays::ghost_cells: the piece's number in mesh.ranks. Triangles with another one are ghosts. A line
  /// counts in the first of the pieces that have its triangles.
  std::int32_t rank = 0;
};

/// The same with the given arrays. The file is complete, but appears under its name only on commit().
[[nodiscard]] std::unique_ptr<FileSink> prepare_vtu(const Mesh& mesh, const VtuArrays& arrays, const std::string& path,
                                                    const VtuGhosts& ghosts = {}, const TriangleData& data = {});

/// An array that a .pvtu declares for each of its pieces.
struct DeclaredArray {
  std::string section;  ///< part of a piece: "PointData"
  std::string name;
  std::uint64_t components = 1;
};

/// Reads what write_vtu writes, and what other programs write of triangles and lines: appended or inline, as bytes, in
/// base64 or as text, compressed by zlib or not. Points may come as any numbers; arrays on cells of other names are
/// ignored. Cells that are ghosts (vtkGhostType) are left out, with points that only they use; a line that is a side of
/// a triangle stays. A piece must have the arrays that are `declared` for it.
/// `data`: those at triangles are put there, unless null (see parse_vtu_triangle_data).
[[nodiscard]] Mesh read_vtu(const std::string& path, std::span<const DeclaredArray> declared = {},
                            TriangleData* data = nullptr);
/// The same from memory; `file` is for messages.
[[nodiscard]] Mesh parse_vtu(const std::string& file, std::string_view bytes,
                             std::span<const DeclaredArray> declared = {});
/// The arrays on cells of other names; those with several components are one each, called u_0, u_1.
[[nodiscard]] TriangleData parse_vtu_triangle_data(const std::string& file, std::string_view bytes);

}  // namespace driftmesh
