#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include "base/file_bytes.hpp"
#include "base/huge_pages.hpp"
#include "base/read_file.hpp"
#include "base/xml_text.hpp"
#include "driftmesh/error.hpp"
#include "io/read_checks.hpp"
#include "io/vtu_format.hpp"
#include "io/vtu_ghosts.hpp"
#include "io/vtu_header.hpp"
#include "io/vtu_values.hpp"
#include "pslg/names.hpp"

namespace driftmesh {
namespace {

// Points are different, so that each takes some bits of zlib's: what shrinks by more than this has repetitions only.
constexpr std::uint64_t kMostShrunkPoints = 200;
constexpr std::uint64_t kMostAttributes = 1000;           // values per point
constexpr std::uint64_t kSmall = std::uint64_t{1} << 20;  // bytes; anything goes below

// Splits the cells into triangles and lines.
class CellSplitter {
 public:
  CellSplitter(const std::string& path, const VtuArrayReader& arrays, std::uint64_t cells)
      : path_(path),
        cells_(cells),
        types_(arrays.open<std::uint8_t>(arrays.get("Cells", "types"), cells)),
        ends_(arrays.open<std::int64_t>(arrays.get("Cells", "offsets"), cells)),
        vertices_(arrays.open_all<std::int32_t>(arrays.get("Cells", "connectivity"))) {}

  /// Only what is right so far takes memory, because offsets ascend, and so do not shrink much.
  void split(Mesh& mesh) {
    reserve_in_huge_pages(mesh.triangles, std::min({cells_, vertices_.size() / 3, ends_.stored()}));
    std::int64_t begin = 0;
    for (std::size_t cell = 0; cell < cells_; ++cell) {
      const std::uint8_t type = types_.next();
      const std::size_t corners = corner_count(cell, type);
      const std::int64_t end = ends_.next();
      if (end != begin + static_cast<std::int64_t>(corners) || std::cmp_greater(end, vertices_.size()))
        throw InputError({path_, 0}, "cell " + std::to_string(cell) + " (counted from 0) has a wrong offset", kDamaged);
      const std::int32_t a = vertices_.next(), b = vertices_.next();
      if (corners == 3) {
        mesh.triangles.push_back({a, b, vertices_.next()});
      } else {
        mesh.edges.push_back({a, b, 0});
        line_cells.push_back(cell);
      }
      begin = end;
    }
    if (std::cmp_not_equal(begin, vertices_.size()))
      throw InputError({path_, 0},
                       "has " + std::to_string(vertices_.size()) + " corners of cells where its offsets tell of " +
                           std::to_string(begin),
                       kDamaged);
  }

  std::vector<std::size_t> line_cells;  // ascending; all others are triangles

 private:
  [[nodiscard]] std::size_t corner_count(std::size_t cell, std::uint8_t type) const {
    if (type == kVtkTriangle) return 3;
    if (type == 3) return 2;
    throw InputError({path_, 0},
                     "cell " + std::to_string(cell) + " (counted from 0) is of VTK type " + std::to_string(type) +
                         ", neither a triangle (5) nor a line (3)",
                     "extract the triangles first");
  }

  const std::string& path_;
  std::uint64_t cells_;
  VtuValues<std::uint8_t> types_;
  VtuValues<std::int64_t> ends_;
  VtuValues<std::int32_t> vertices_;
};

void read_points(Mesh& mesh, const std::string& path, const VtuArrayReader& arrays, std::uint64_t count) {
  const VtuHeader::Array& array = arrays.get("Points", "Points");
  if (array.components != 3) throw InputError({path, array.line}, "the points need NumberOfComponents=\"3\"", kDamaged);
  VtuValues<double> xyz = arrays.open<double>(array, count, 3);
  if (xyz.bytes() > kSmall && xyz.bytes() / kMostShrunkPoints > xyz.stored())
    throw InputError({path, array.line},
                     "has " + std::to_string(count) + " points in " + std::to_string(xyz.stored()) +
                         " bytes, so that most are the same",
                     kDamaged);
  reserve_in_huge_pages(mesh.points, count);
  double z = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double x = xyz.next(), y = xyz.next(), own = xyz.next();
    if (i == 0) z = own;
    if (own != z)
      throw InputError({path, 0}, "is not planar: its points differ in z", "only planar meshes can be read");
    mesh.points.push_back({x, y});
  }
}

/// The attributes that have names, each an array of its own.
void read_named_attributes(Mesh& mesh, const VtuArrayReader& arrays, std::uint64_t count) {
  const std::size_t width = mesh.attribute_names.size();
  for (std::size_t k = 0; k < width; ++k) {
    const std::string name = escaped(mesh.attribute_names[k]);
    const std::vector<double> values = arrays.open<double>(arrays.get("PointData", name.c_str()), count).all();
    mesh.attributes.resize(values.size() * width);
    for (std::size_t v = 0; v < values.size(); ++v) mesh.attributes[v * width + k] = values[v];
  }
  mesh.attributes_per_point = static_cast<std::int32_t>(width);
}

/// Point data of other programs become attributes, by name; those with several components one for each, called u_0,
/// u_1.
void read_other_point_data(Mesh& mesh, const VtuHeader& header, const VtuArrayReader& arrays, std::uint64_t count) {
  std::vector<std::vector<double>> columns;
  for (const auto& [place, array] : header.arrays) {
    const std::string name = unescaped(place.second);
    if (place.first != "PointData" || is_array_on_points(name) || !fault_of_name(name).empty()) continue;
    const std::vector<double> values = arrays.open<double>(array, count, kMostAttributes).all();
    for (std::size_t k = 0; k < array.components; ++k) {
      const std::string own = array.components == 1 ? name : name + "_" + std::to_string(k);
      if (std::ranges::count(mesh.attribute_names, own) > 0) continue;
      mesh.attribute_names.push_back(own);
      std::vector<double>& column = columns.emplace_back(count);
      for (std::size_t v = 0; v < count; ++v) column[v] = values[v * array.components + k];
    }
  }
  const std::size_t width = columns.size();
  mesh.attributes.resize(count * width);
  for (std::size_t k = 0; k < width; ++k)
    for (std::size_t v = 0; v < count; ++v) mesh.attributes[v * width + k] = columns[k][v];
  mesh.attributes_per_point = static_cast<std::int32_t>(width);
}

void read_point_data(Mesh& mesh, const VtuHeader& header, const VtuArrayReader& arrays, std::uint64_t count) {
  if (const VtuHeader::Array* const marker = arrays.find("PointData", "marker"))
    mesh.point_markers = arrays.open<std::int32_t>(*marker, count).all();
  if (!mesh.attribute_names.empty()) {
    read_named_attributes(mesh, arrays, count);
  } else if (const VtuHeader::Array* const attribute = arrays.find("PointData", "attribute")) {
    mesh.attributes = arrays.open<double>(*attribute, count, kMostAttributes).all();
    mesh.attributes_per_point = static_cast<std::int32_t>(attribute->components);
  } else {
    read_other_point_data(mesh, header, arrays, count);
  }
  if (const VtuHeader::Array* const number = arrays.find("PointData", "global_number"))
    mesh.numbers = arrays.open<std::int64_t>(*number, count).all();
}

/// None without the array.
GhostCells read_ghosts(const VtuArrayReader& arrays, const CellSplitter& cells, std::uint64_t count) {
  GhostCells ghosts;
  const VtuHeader::Array* const array = arrays.find("CellData", "vtkGhostType");
  if (array == nullptr) return ghosts;
  VtuValues<std::uint8_t> types = arrays.open<std::uint8_t>(*array, count);
  auto line = cells.line_cells.begin();
  for (std::size_t cell = 0; cell < count; ++cell) {
    const bool is_line = line != cells.line_cells.end() && *line == cell;
    if (is_line) ++line;
    (is_line ? ghosts.edges : ghosts.triangles).push_back((types.next() & kDuplicate) != 0);
  }
  return ghosts;
}

GhostCells read_cells(Mesh& mesh, const std::string& path, const VtuArrayReader& arrays, std::uint64_t count) {
  CellSplitter cells(path, arrays, count);
  cells.split(mesh);
  if (const VtuHeader::Array* const marker = arrays.find("CellData", "marker")) {
    VtuValues<std::int32_t> markers = arrays.open<std::int32_t>(*marker, count);
    auto edge = mesh.edges.begin();
    for (std::size_t cell = 0; cell < count; ++cell)
      if (const std::int32_t own = markers.next();
          edge != mesh.edges.end() && cells.line_cells[static_cast<std::size_t>(edge - mesh.edges.begin())] == cell)
        (edge++)->marker = own;
  }
  const auto load_of_triangles = [&]<class T>(const char* name, std::vector<T>& values) {
    const VtuHeader::Array* const array = arrays.find("CellData", name);
    if (array == nullptr) return;
    VtuValues<T> of_cells = arrays.open<T>(*array, count);
    reserve_in_huge_pages(values, mesh.triangles.size());
    auto line = cells.line_cells.begin();
    for (std::size_t cell = 0; cell < count; ++cell) {
      const T own = of_cells.next();
      if (line != cells.line_cells.end() && *line == cell)
        ++line;
      else
        values.push_back(own);
    }
  };
  load_of_triangles("region", mesh.regions);
  load_of_triangles("subdomain", mesh.subdomains);
  load_of_triangles("rank", mesh.ranks);
  return read_ghosts(arrays, cells, count);
}

/// Before the attributes, which are found by their names.
void read_names(Mesh& mesh, const std::string& path, const VtuHeader& header, const VtuArrayReader& arrays) {
  std::map<std::int32_t, std::string> attributes;
  for (const auto& [place, array] : header.arrays) {
    const auto& [section, name] = place;
    if (section == VtuHeader::kMarkerNames)
      add_marker_name(mesh.names, arrays.open<std::int32_t>(array, 1, 2).next(), unescaped(name));
    if (section == VtuHeader::kRegionNames)
      add_region_name(mesh.names, arrays.open<double>(array, 1, 2).next(), unescaped(name));
    if (section == VtuHeader::kAttributeNames)
      attributes.emplace(arrays.open<std::int32_t>(array, 1, 2).next(), unescaped(name));
    if (section == VtuHeader::kCoordinates && fault_of_name(unescaped(name)).empty())
      mesh.coordinates = unescaped(name);
  }
  for (const auto& [number, name] : attributes) {
    if (std::cmp_not_equal(number, mesh.attribute_names.size()))
      throw InputError({path, 0}, "has names of attributes that are not numbered from 0 on", kDamaged);
    mesh.attribute_names.push_back(name);
  }
}

void require_array(const std::string& file, const VtuHeader& header, const DeclaredArray& declared) {
  const auto found = header.arrays.find({declared.section, declared.name});
  const std::string words = "array '" + declared.name + "' in <" + declared.section + ">";
  if (found == header.arrays.end())
    throw InputError({file, 0}, "has no " + words + ", which its .pvtu declares", kDamaged);
  if (found->second.components != declared.components)
    throw InputError({file, found->second.line},
                     "has " + std::to_string(found->second.components) + " components in its " + words +
                         ", and its .pvtu declares " + std::to_string(declared.components),
                     kDamaged);
}

}  // namespace

Mesh parse_vtu(const std::string& file, std::string_view bytes, std::span<const DeclaredArray> declared) {
  const VtuHeader header = parse_vtu_header(file, bytes);
  for (const DeclaredArray& array : declared) require_array(file, header, array);
  const VtuArrayReader arrays(file, header);
  Mesh mesh;
  read_points(mesh, file, arrays, header.points);
  read_names(mesh, file, header, arrays);
  read_point_data(mesh, header, arrays, header.points);
  const GhostCells ghosts = read_cells(mesh, file, arrays, header.cells);
  check_read_mesh(mesh, file);
  if (std::ranges::count(ghosts.triangles, true) > 0) drop_ghosts(mesh, ghosts);
  return mesh;
}

Mesh read_vtu(const std::string& path, std::span<const DeclaredArray> declared, TriangleData* data) {
  const FileBytes bytes(path, kBeginsXml);
  Mesh mesh = parse_vtu(path, bytes.view(), declared);
  if (data != nullptr) *data = parse_vtu_triangle_data(path, bytes.view());
  return mesh;
}

}  // namespace driftmesh
