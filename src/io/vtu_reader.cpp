#include <charconv>
#include <map>
#include <optional>
#include <utility>

#include "base/read_file.hpp"
#include "driftmesh/error.hpp"
#include "io/byte_cursor.hpp"
#include "io/read_checks.hpp"
#include "io/vtu_format.hpp"
#include "io/xml_scanner.hpp"

namespace driftmesh {
namespace {

const char* const kSaveAs = "save it as an uncompressed .vtu with appended data, encoding raw";

struct DataArray {
  std::string type;
  std::uint64_t offset = 0;
  std::uint64_t components = 1;
  std::size_t line = 0;
};

using ArrayName = std::pair<std::string, std::string>;  // section (PointData, ...) and Name

// What the XML before the binary data says.
struct Header {
  std::uint64_t points = 0;
  std::uint64_t cells = 0;
  bool wide_lengths = true;  // the arrays' byte counts are UInt64, not UInt32
  std::map<ArrayName, DataArray> arrays;
  std::size_t data_begin = 0;
};

class HeaderParser {
 public:
  HeaderParser(const std::string& path, std::string_view text) : path_(path), text_(text), scanner_(path, text) {}

  Header parse() {
    XmlTag tag;
    while (scanner_.next(tag)) {
      if (tag.name == "AppendedData") return finish(tag);
      if (tag.opens) enter(tag);
    }
    throw InputError({path_, 0}, "has no AppendedData section", kSaveAs);
  }

 private:
  void enter(const XmlTag& tag) {
    if (tag.name == "VTKFile") read_file_tag(tag);
    if (tag.name == "Piece") read_piece_tag(tag);
    if (tag.name == "PointData" || tag.name == "CellData" || tag.name == "Points" || tag.name == "Cells")
      section_ = tag.name;
    if (tag.name == "DataArray") read_array_tag(tag);
  }

  void read_file_tag(const XmlTag& tag) {
    if (tag.attribute("type") != "UnstructuredGrid") fail(tag, "is not of type UnstructuredGrid", kSaveAs);
    if (tag.attribute("byte_order", "LittleEndian") != "LittleEndian") fail(tag, "is big-endian", kSaveAs);
    if (!tag.attribute("compressor").empty()) fail(tag, "is compressed", kSaveAs);
    const std::string_view lengths = tag.attribute("header_type", "UInt32");
    if (lengths != "UInt32" && lengths != "UInt64") fail(tag, "has an unknown header_type", kSaveAs);
    header_.wide_lengths = lengths == "UInt64";
    seen_file_ = true;
  }

  void read_piece_tag(const XmlTag& tag) {
    if (!seen_file_) fail(tag, "is not a VTK file", kSaveAs);
    if (seen_piece_) fail(tag, "has more than one Piece", "merge the pieces first");
    seen_piece_ = true;
    header_.points = count(tag, "NumberOfPoints");
    header_.cells = count(tag, "NumberOfCells");
  }

  void read_array_tag(const XmlTag& tag) {
    if (section_.empty()) return;  // field data
    if (tag.attribute("format") != "appended")
      fail(tag, "has a DataArray of format '" + std::string(tag.attribute("format")) + "'", kSaveAs);
    DataArray array;
    array.type = tag.attribute("type");
    array.offset = count(tag, "offset");
    array.components = tag.attribute("NumberOfComponents").empty() ? 1 : count(tag, "NumberOfComponents");
    array.line = tag.line;
    const std::string name = section_ == "Points" ? "Points" : std::string(tag.attribute("Name"));
    header_.arrays[{section_, name}] = array;
  }

  Header finish(const XmlTag& tag) {
    if (!seen_piece_) fail(tag, "has no Piece", kSaveAs);
    if (tag.attribute("encoding") != "raw")
      fail(tag, "has appended data of encoding '" + std::string(tag.attribute("encoding")) + "'", kSaveAs);
    const std::size_t underscore = text_.find('_', scanner_.position());
    if (underscore == std::string_view::npos) fail(tag, "ends before its data", kDamaged);
    header_.data_begin = underscore + 1;
    return std::move(header_);
  }

  std::uint64_t count(const XmlTag& tag, std::string_view key) const {
    const std::string_view digits = tag.attribute(key);
    std::uint64_t value = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (digits.empty() || error != std::errc() || end != digits.data() + digits.size())
      fail(tag, "needs " + std::string(key) + "=\"a number\" in <" + std::string(tag.name) + ">", kDamaged);
    return value;
  }

  [[noreturn]] void fail(const XmlTag& tag, const std::string& what, const char* next) const {
    throw InputError({path_, tag.line}, what, next);
  }

  const std::string& path_;
  std::string_view text_;
  XmlScanner scanner_;
  Header header_;
  std::string section_;
  bool seen_file_ = false;
  bool seen_piece_ = false;
};

// The arrays by name, converted to the types that a Mesh has.
class ArrayReader {
 public:
  ArrayReader(const std::string& path, const Header& header, std::string_view data)
      : path_(path), header_(header), data_(data) {}

  [[nodiscard]] const DataArray* find(const char* section, const char* name) const {
    const auto found = header_.arrays.find({section, name});
    return found == header_.arrays.end() ? nullptr : &found->second;
  }

  [[nodiscard]] const DataArray& get(const char* section, const char* name) const {
    if (const DataArray* const array = find(section, name)) return *array;
    throw InputError({path_, 0}, std::string("has no array '") + name + "' in <" + section + ">", kDamaged);
  }

  /// `tuples` x components values.
  template <class To>
  [[nodiscard]] std::vector<To> load(const DataArray& array, std::uint64_t tuples) const {
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
    throw InputError({path_, array.line}, "DataArray of unknown type '" + array.type + "'", kSaveAs);
  }

 private:
  template <class To, class From>
  [[nodiscard]] std::vector<To> convert(const DataArray& array, std::uint64_t tuples) const {
    const std::string_view bytes = stored_bytes(array);
    const std::uint64_t values = bytes.size() / sizeof(From);
    const bool fits = array.components > 0 && values % array.components == 0 && values / array.components == tuples &&
                      bytes.size() % sizeof(From) == 0;
    if (!fits)
      throw InputError({path_, array.line},
                       "DataArray holds " + std::to_string(bytes.size()) + " bytes, not " + std::to_string(tuples) +
                           " x " + std::to_string(array.components) + " " + array.type,
                       kDamaged);
    std::vector<To> result(values);
    if constexpr (std::is_same_v<To, From>) {
      if (!bytes.empty()) std::memcpy(result.data(), bytes.data(), bytes.size());
    } else {
      for (std::size_t i = 0; i < result.size(); ++i) {
        From value;
        std::memcpy(&value, bytes.data() + i * sizeof(From), sizeof(From));
        result[i] = checked<To>(value, array);
      }
    }
    return result;
  }

  [[nodiscard]] std::string_view stored_bytes(const DataArray& array) const {
    ByteCursor cursor(path_, data_);
    (void)cursor.take_bytes(array.offset, 1, "its data");
    const std::uint64_t length = header_.wide_lengths ? cursor.take<std::uint64_t>("its data")
                                                      : std::uint64_t{cursor.take<std::uint32_t>("its data")};
    return cursor.take_bytes(length, 1, "its data");
  }

  template <class To, class From>
  [[nodiscard]] To checked(From value, const DataArray& array) const {
    if constexpr (std::is_floating_point_v<To>) {
      return static_cast<To>(value);
    } else if constexpr (std::is_integral_v<From>) {
      if (std::in_range<To>(value)) return static_cast<To>(value);
    }
    throw InputError({path_, array.line}, "DataArray holds a value that is out of range for its purpose", kDamaged);
  }

  const std::string& path_;
  const Header& header_;
  std::string_view data_;
};

// Splits the cells into triangles and lines, each with its position among all cells.
class CellSplitter {
 public:
  CellSplitter(const std::string& path, const ArrayReader& arrays, std::uint64_t cells)
      : path_(path),
        types_(arrays.load<std::uint8_t>(arrays.get("Cells", "types"), cells)),
        ends_(arrays.load<std::int64_t>(arrays.get("Cells", "offsets"), cells)),
        vertices_(arrays.load<std::int32_t>(arrays.get("Cells", "connectivity"),
                                            ends_.empty() ? 0 : static_cast<std::uint64_t>(ends_.back()))) {}

  void split(Mesh& mesh) {
    std::int64_t begin = 0;
    for (std::size_t cell = 0; cell < types_.size(); ++cell) {
      const std::size_t corners = corner_count(cell);
      if (ends_[cell] != begin + static_cast<std::int64_t>(corners) || std::cmp_greater(ends_[cell], vertices_.size()))
        throw InputError({path_, 0}, "cell " + std::to_string(cell) + " (counted from 0) has a wrong offset", kDamaged);
      const std::int32_t* const corner = vertices_.data() + begin;
      if (corners == 3) {
        mesh.triangles.push_back({corner[0], corner[1], corner[2]});
        triangle_cells.push_back(cell);
      } else {
        mesh.edges.push_back({corner[0], corner[1], 0});
        line_cells.push_back(cell);
      }
      begin = ends_[cell];
    }
  }

  std::vector<std::size_t> triangle_cells;
  std::vector<std::size_t> line_cells;

 private:
  [[nodiscard]] std::size_t corner_count(std::size_t cell) const {
    if (types_[cell] == 5) return 3;
    if (types_[cell] == 3) return 2;
    throw InputError({path_, 0},
                     "cell " + std::to_string(cell) + " (counted from 0) is of VTK type " +
                         std::to_string(types_[cell]) + ", neither a triangle (5) nor a line (3)",
                     "extract the triangles first");
  }

  const std::string& path_;
  std::vector<std::uint8_t> types_;
  std::vector<std::int64_t> ends_;
  std::vector<std::int32_t> vertices_;
};

void read_points(Mesh& mesh, const std::string& path, const ArrayReader& arrays, std::uint64_t count) {
  const DataArray& array = arrays.get("Points", "Points");
  if (array.components != 3) throw InputError({path, array.line}, "the points need NumberOfComponents=\"3\"", kDamaged);
  const std::vector<double> xyz = arrays.load<double>(array, count);
  mesh.points.reserve(xyz.size() / 3);
  for (std::size_t i = 0; i < xyz.size(); i += 3) {
    if (xyz[i + 2] != xyz[2])
      throw InputError({path, 0}, "is not planar: its points differ in z", "only planar meshes can be read");
    mesh.points.push_back({xyz[i], xyz[i + 1]});
  }
}

void read_point_data(Mesh& mesh, const ArrayReader& arrays, std::uint64_t count) {
  if (const DataArray* const marker = arrays.find("PointData", "marker"))
    mesh.point_markers = arrays.load<std::int32_t>(*marker, count);
  if (const DataArray* const attribute = arrays.find("PointData", "attribute")) {
    mesh.attributes = arrays.load<double>(*attribute, count);
    mesh.attributes_per_point = static_cast<std::int32_t>(std::min<std::uint64_t>(attribute->components, 1 << 20));
  }
  if (const DataArray* const number = arrays.find("PointData", "global_number"))
    mesh.numbers = arrays.load<std::int64_t>(*number, count);
}

void read_cells(Mesh& mesh, const std::string& path, const ArrayReader& arrays, std::uint64_t count) {
  CellSplitter cells(path, arrays, count);
  cells.split(mesh);
  if (const DataArray* const marker = arrays.find("CellData", "marker")) {
    const std::vector<std::int32_t> markers = arrays.load<std::int32_t>(*marker, count);
    for (std::size_t e = 0; e < mesh.edges.size(); ++e) mesh.edges[e].marker = markers[cells.line_cells[e]];
  }
  const auto load_of_triangles = [&]<class T>(const char* name, std::vector<T>& values) {
    const DataArray* const array = arrays.find("CellData", name);
    if (array == nullptr) return;
    const std::vector<T> of_cells = arrays.load<T>(*array, count);
    values.reserve(cells.triangle_cells.size());
    for (std::size_t cell : cells.triangle_cells) values.push_back(of_cells[cell]);
  };
  load_of_triangles("region", mesh.regions);
  load_of_triangles("subdomain", mesh.subdomains);
  load_of_triangles("rank", mesh.ranks);
}

}  // namespace

Mesh parse_vtu(const std::string& file, std::string_view bytes) {
  const Header header = HeaderParser(file, bytes).parse();
  const ArrayReader arrays(file, header, bytes.substr(header.data_begin));
  Mesh mesh;
  read_points(mesh, file, arrays, header.points);
  read_point_data(mesh, arrays, header.points);
  read_cells(mesh, file, arrays, header.cells);
  check_read_mesh(mesh, file);
  return mesh;
}

Mesh read_vtu(const std::string& path) {
  return parse_vtu(path, read_file(path));
}

}  // namespace driftmesh
