#include <algorithm>
#include <charconv>
#include <cstring>
#include <utility>

#include "base/file_bytes.hpp"
#include "base/huge_pages.hpp"
#include "base/xml_text.hpp"
#include "driftmesh/error.hpp"
#include "io/byte_cursor.hpp"
#include "io/read_checks.hpp"
#include "io/vtu_data.hpp"
#include "io/vtu_format.hpp"
#include "io/vtu_ghosts.hpp"
#include "io/vtu_header.hpp"
#include "pslg/names.hpp"

namespace driftmesh {
namespace {

constexpr std::uint64_t kMostTuples = std::uint64_t{1} << 48;  // of any array that a machine can hold

/// The values of an array. Those that the file holds as they are needed stay there.
template <class T>
class Values {
 public:
  Values(std::string_view bytes, std::string&& unpacked) : unpacked_(std::move(unpacked)), bytes_(bytes) {
    if (!unpacked_.empty()) bytes_ = unpacked_;
  }
  explicit Values(std::vector<T>&& converted)
      : converted_(std::move(converted)),
        bytes_(reinterpret_cast<const char*>(converted_.data()), converted_.size() * sizeof(T)) {}
  Values(const Values&) = delete;
  Values& operator=(const Values&) = delete;

  [[nodiscard]] std::size_t size() const { return bytes_.size() / sizeof(T); }
  [[nodiscard]] T operator[](std::size_t i) const {
    T value;
    std::memcpy(&value, bytes_.data() + i * sizeof(T), sizeof(T));
    return value;
  }
  [[nodiscard]] std::vector<T> all() const {
    std::vector<T> copy;
    reserve_in_huge_pages(copy, size());
    copy.resize(size());
    if (!bytes_.empty()) std::memcpy(copy.data(), bytes_.data(), bytes_.size());
    return copy;
  }

 private:
  std::vector<T> converted_;
  std::string unpacked_;
  std::string_view bytes_;
};

// The arrays by name, converted to the types that a Mesh has.
class ArrayReader {
 public:
  ArrayReader(const std::string& path, const VtuHeader& header) : path_(path), header_(header), data_(path, header) {}

  [[nodiscard]] const VtuHeader::Array* find(const char* section, const char* name) const {
    const auto found = header_.arrays.find({section, name});
    return found == header_.arrays.end() ? nullptr : &found->second;
  }

  [[nodiscard]] const VtuHeader::Array& get(const char* section, const char* name) const {
    if (const VtuHeader::Array* const array = find(section, name)) return *array;
    throw InputError({path_, 0}, std::string("has no array '") + name + "' in <" + section + ">", kDamaged);
  }

  /// `tuples` x components values.
  template <class To>
  [[nodiscard]] Values<To> load(const VtuHeader::Array& array, std::uint64_t tuples) const {
    if (array.type == "Float64") return convert<To, double>(array, tuples);
    if (array.type == "Float32") return convert<To, float>(array, tuples);
    if (array.type == "Int8") return convert<To, std::int8_t>(array, tuples);
    if (array.type == "UInt8") return convert<To, std::uint8_t>(array, tuples);
    if (array.type == "Int16") return convert<To, std::int16_t>(array, tuples);
    if (array.type == "UInt16") return convert<To, std::uint16_t>(array, tuples);
    if (array.type == "Int32") return convert<To, std::int32_t>(array, tuples);
    if (array.type == "UInt32") return convert<To, std::uint32_t>(array, tuples);
    if (array.type == "Int64") return convert<To, std::int64_t>(array, tuples);
    if (array.type == "UInt64") return convert<To, std::uint64_t>(array, tuples);
    throw InputError({path_, array.line}, "DataArray of unknown type '" + array.type + "'", kSaveVtuAs);
  }

 private:
  template <class To, class From>
  [[nodiscard]] Values<To> convert(const VtuHeader::Array& array, std::uint64_t tuples) const {
    if (array.components == 0 || array.components > kMostTuples || tuples > kMostTuples / array.components)
      throw InputError(
          {path_, array.line},
          "a DataArray of " + std::to_string(tuples) + " x " + std::to_string(array.components) + " values", kDamaged);
    const std::uint64_t count = tuples * array.components;
    if (array.format == VtuHeader::Format::kAscii) return Values<To>(parse_text<To, From>(array, count));
    std::string storage;
    const std::string_view bytes = data_.bytes(array, count * sizeof(From), storage);
    if constexpr (std::is_same_v<To, From>) {
      return Values<To>(bytes, std::move(storage));
    } else {
      std::vector<To> result;
      reserve_in_huge_pages(result, count);
      for (std::size_t i = 0; i < count; ++i) {
        From value;
        std::memcpy(&value, bytes.data() + i * sizeof(From), sizeof(From));
        result.push_back(checked<To>(value, array));
      }
      return Values<To>(std::move(result));
    }
  }

  template <class To, class From>
  [[nodiscard]] std::vector<To> parse_text(const VtuHeader::Array& array, std::uint64_t count) const {
    std::vector<To> result;
    result.reserve(std::min<std::uint64_t>(count, array.text.size() / 2 + 1));
    const char *at = array.text.data(), *const end = at + array.text.size();
    while (true) {
      while (at != end && ByteCursor::is_blank(*at)) ++at;
      if (at == end) break;
      From value{};
      const auto [stop, error] = std::from_chars(at, end, value);
      if (error != std::errc() || (stop != end && !ByteCursor::is_blank(*stop)))
        throw InputError({path_, array.line}, "a DataArray holds text that is not " + array.type, kDamaged);
      result.push_back(checked<To>(value, array));
      at = stop;
    }
    if (result.size() != count)
      throw InputError({path_, array.line},
                       "a DataArray holds " + std::to_string(result.size()) + " values, not " + std::to_string(count),
                       kDamaged);
    return result;
  }

  template <class To, class From>
  [[nodiscard]] To checked(From value, const VtuHeader::Array& array) const {
    if constexpr (std::is_floating_point_v<To>) {
      return static_cast<To>(value);
    } else if constexpr (std::is_integral_v<From>) {
      if (std::in_range<To>(value)) return static_cast<To>(value);
    }
    throw InputError({path_, array.line}, "DataArray holds a value that is out of range for its purpose", kDamaged);
  }

  const std::string& path_;
  const VtuHeader& header_;
  VtuData data_;
};

// Splits the cells into triangles and lines.
class CellSplitter {
 public:
  CellSplitter(const std::string& path, const ArrayReader& arrays, std::uint64_t cells)
      : path_(path),
        types_(arrays.load<std::uint8_t>(arrays.get("Cells", "types"), cells)),
        ends_(arrays.load<std::int64_t>(arrays.get("Cells", "offsets"), cells)),
        vertices_(arrays.load<std::int32_t>(arrays.get("Cells", "connectivity"),
                                            cells == 0 ? 0 : static_cast<std::uint64_t>(ends_[cells - 1]))) {}

  void split(Mesh& mesh) {
    reserve_in_huge_pages(mesh.triangles, vertices_.size() / 3);
    std::int64_t begin = 0;
    for (std::size_t cell = 0; cell < types_.size(); ++cell) {
      const std::size_t corners = corner_count(cell);
      if (ends_[cell] != begin + static_cast<std::int64_t>(corners) || std::cmp_greater(ends_[cell], vertices_.size()))
        throw InputError({path_, 0}, "cell " + std::to_string(cell) + " (counted from 0) has a wrong offset", kDamaged);
      const auto corner = [&](std::size_t k) { return vertices_[static_cast<std::size_t>(begin) + k]; };
      if (corners == 3) {
        mesh.triangles.push_back({corner(0), corner(1), corner(2)});
      } else {
        mesh.edges.push_back({corner(0), corner(1), 0});
        line_cells.push_back(cell);
      }
      begin = ends_[cell];
    }
  }

  std::vector<std::size_t> line_cells;  // ascending; all others are triangles

 private:
  [[nodiscard]] std::size_t corner_count(std::size_t cell) const {
    if (types_[cell] == kVtkTriangle) return 3;
    if (types_[cell] == 3) return 2;
    throw InputError({path_, 0},
                     "cell " + std::to_string(cell) + " (counted from 0) is of VTK type " +
                         std::to_string(types_[cell]) + ", neither a triangle (5) nor a line (3)",
                     "extract the triangles first");
  }

  const std::string& path_;
  Values<std::uint8_t> types_;
  Values<std::int64_t> ends_;
  Values<std::int32_t> vertices_;
};

void read_points(Mesh& mesh, const std::string& path, const ArrayReader& arrays, std::uint64_t count) {
  const VtuHeader::Array& array = arrays.get("Points", "Points");
  if (array.components != 3) throw InputError({path, array.line}, "the points need NumberOfComponents=\"3\"", kDamaged);
  const Values<double> xyz = arrays.load<double>(array, count);
  reserve_in_huge_pages(mesh.points, xyz.size() / 3);
  for (std::size_t i = 0; i < xyz.size(); i += 3) {
    if (xyz[i + 2] != xyz[2])
      throw InputError({path, 0}, "is not planar: its points differ in z", "only planar meshes can be read");
    mesh.points.push_back({xyz[i], xyz[i + 1]});
  }
}

void read_point_data(Mesh& mesh, const ArrayReader& arrays, std::uint64_t count) {
  if (const VtuHeader::Array* const marker = arrays.find("PointData", "marker"))
    mesh.point_markers = arrays.load<std::int32_t>(*marker, count).all();
  if (const VtuHeader::Array* const attribute = arrays.find("PointData", "attribute")) {
    mesh.attributes = arrays.load<double>(*attribute, count).all();
    mesh.attributes_per_point = static_cast<std::int32_t>(std::min<std::uint64_t>(attribute->components, 1 << 20));
  }
  if (const VtuHeader::Array* const number = arrays.find("PointData", "global_number"))
    mesh.numbers = arrays.load<std::int64_t>(*number, count).all();
}

/// None without the array.
GhostCells read_ghosts(const ArrayReader& arrays, const CellSplitter& cells, std::uint64_t count) {
  GhostCells ghosts;
  const VtuHeader::Array* const array = arrays.find("CellData", "vtkGhostType");
  if (array == nullptr) return ghosts;
  const Values<std::uint8_t> types = arrays.load<std::uint8_t>(*array, count);
  auto line = cells.line_cells.begin();
  for (std::size_t cell = 0; cell < count; ++cell) {
    const bool is_line = line != cells.line_cells.end() && *line == cell;
    if (is_line) ++line;
    (is_line ? ghosts.edges : ghosts.triangles).push_back((types[cell] & kDuplicate) != 0);
  }
  return ghosts;
}

GhostCells read_cells(Mesh& mesh, const std::string& path, const ArrayReader& arrays, std::uint64_t count) {
  CellSplitter cells(path, arrays, count);
  cells.split(mesh);
  if (const VtuHeader::Array* const marker = arrays.find("CellData", "marker")) {
    const Values<std::int32_t> markers = arrays.load<std::int32_t>(*marker, count);
    for (std::size_t e = 0; e < mesh.edges.size(); ++e) mesh.edges[e].marker = markers[cells.line_cells[e]];
  }
  const auto load_of_triangles = [&]<class T>(const char* name, std::vector<T>& values) {
    const VtuHeader::Array* const array = arrays.find("CellData", name);
    if (array == nullptr) return;
    const Values<T> of_cells = arrays.load<T>(*array, count);
    reserve_in_huge_pages(values, mesh.triangles.size());
    auto line = cells.line_cells.begin();
    for (std::size_t cell = 0; cell < count; ++cell)
      if (line != cells.line_cells.end() && *line == cell)
        ++line;
      else
        values.push_back(of_cells[cell]);
  };
  load_of_triangles("region", mesh.regions);
  load_of_triangles("subdomain", mesh.subdomains);
  load_of_triangles("rank", mesh.ranks);
  return read_ghosts(arrays, cells, count);
}

void read_names(Mesh& mesh, const VtuHeader& header, const ArrayReader& arrays) {
  for (const auto& [place, array] : header.arrays) {
    const auto& [section, name] = place;
    if (section == VtuHeader::kMarkerNames)
      add_marker_name(mesh.names, arrays.load<std::int32_t>(array, 1)[0], unescaped(name));
    if (section == VtuHeader::kRegionNames)
      add_region_name(mesh.names, arrays.load<double>(array, 1)[0], unescaped(name));
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
  const ArrayReader arrays(file, header);
  Mesh mesh;
  read_points(mesh, file, arrays, header.points);
  read_point_data(mesh, arrays, header.points);
  const GhostCells ghosts = read_cells(mesh, file, arrays, header.cells);
  read_names(mesh, header, arrays);
  check_read_mesh(mesh, file);
  if (std::ranges::count(ghosts.triangles, true) > 0) drop_ghosts(mesh, ghosts);
  return mesh;
}

Mesh read_vtu(const std::string& path, std::span<const DeclaredArray> declared) {
  const FileBytes bytes(path);
  return parse_vtu(path, bytes.view(), declared);
}

}  // namespace driftmesh
