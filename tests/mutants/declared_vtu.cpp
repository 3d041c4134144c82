#include "mutants/declared_vtu.hpp"

#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <set>
#include <utility>

#include "mutants/declared_mesh.hpp"
#include "mutants/joined_pieces.hpp"
#include "mutants/vtu_values.hpp"
#include "mutants/xml_tree.hpp"
#include "pslg/names.hpp"

namespace driftmesh::mutants {
namespace {

constexpr std::uint64_t kMostBytes = std::uint64_t{1} << 32;

/// Bytes of a file, as they are or in base64.
class Stored {
 public:
  Stored(std::string_view text, bool is_raw) : text_(text), is_raw_(is_raw), base64_(text) {}
  std::string take(std::uint64_t count) {
    if (!is_raw_) return base64_.take(count);
    if (count > text_.size() - raw_position_) throw Undeclared("data end early");
    raw_position_ += count;
    return std::string(text_.substr(raw_position_ - count, count));
  }
  [[nodiscard]] std::size_t position() const { return is_raw_ ? raw_position_ : base64_.position(); }
  [[nodiscard]] std::size_t most_left() const { return text_.size() - position() + 3; }

 private:
  std::string_view text_;
  bool is_raw_;
  std::size_t raw_position_ = 0;
  Base64Text base64_;
};

class VtuFile {
 public:
  VtuFile(std::string_view bytes, Fields& fields) : bytes_(bytes), fields_(fields), tree_(xml_tree(bytes, fields)) {
    const Element& root = tree_.root;
    if (root.name != "VTKFile" || root.attribute("type") != "UnstructuredGrid") throw Undeclared("no grid of VTK");
    if (root.attribute("byte_order", "LittleEndian") != "LittleEndian") throw Undeclared("another byte order");
    const std::string lengths = root.attribute("header_type", "UInt32");
    if (lengths != "UInt32" && lengths != "UInt64") throw Undeclared("lengths of unknown type");
    length_bytes_ = lengths == "UInt64" ? 8 : 4;
    const std::string compressor = root.attribute("compressor");
    if (!compressor.empty() && compressor != "vtkZLibDataCompressor") throw Undeclared("an unknown compressor");
    is_compressed_ = !compressor.empty();
    piece_ = &root.only("UnstructuredGrid").only("Piece");
    find_appended();
    read_others(root);
    check_end();
  }

  Mesh mesh() {
    const std::uint64_t points = piece_->count("NumberOfPoints"), cells = piece_->count("NumberOfCells");
    read_points(points);
    read_point_data(points);
    read_cells(cells);
    read_cell_data(cells);
    turn_if_seen_from_below(mesh_);
    return std::move(mesh_);
  }

  /// How many components an array has; 0 if there is none.
  [[nodiscard]] std::uint64_t components(const std::string& section, const std::string& name) const {
    const Element* const array = find(section, name);
    return array == nullptr ? 0 : components_of(*array);
  }

 private:
  static std::uint64_t components_of(const Element& array) {
    return array.attribute("NumberOfComponents").empty() ? 1 : array.count("NumberOfComponents");
  }

  [[nodiscard]] const Element* find(const std::string& section, const std::string& name) const {
    const Element* found = nullptr;
    for (const Element& part : piece_->children) {
      if (part.name != section) continue;
      for (const Element& array : part.children) {
        if (array.name != "DataArray" || (section != "Points" && array.attribute("Name") != name)) continue;
        if (found != nullptr) throw Undeclared("two arrays " + name);
        found = &array;
      }
    }
    return found;
  }

  void find_appended() {
    if (tree_.appended.data() == nullptr) return;
    const Element& tag = tree_.root.only("AppendedData");
    const std::string encoding = tag.attribute("encoding");
    if (encoding != "raw" && encoding != "base64") throw Undeclared("an unknown encoding");
    is_raw_ = encoding == "raw";
    const std::size_t begin = tree_.appended.find_first_not_of(kXmlBlanks);
    if (begin == std::string_view::npos || tree_.appended[begin] != '_') throw Undeclared("no data behind their tag");
    appended_ = tree_.appended.substr(begin + 1);
  }

  /// Appended data of arrays that nobody asks for count, too, for the place where the data end.
  void read_others(const Element& element) {
    for (const Element& child : element.children) {
      read_others(child);
      if ((child.name == "DataArray" || child.name == "Array") && child.attribute("format") == "appended")
        skip_appended(child);
    }
  }

  void skip_appended(const Element& array) {
    const std::uint64_t offset = array.count("offset");
    if (offset > appended_.size()) throw Undeclared("no such place");
    Stored stored(appended_.substr(offset), is_raw_);
    for (const std::uint64_t size : stored_sizes(stored)) (void)taken(stored, size);
    end_ = std::max(end_, offset + stored.position());
  }

  void check_end() const {
    if (tree_.appended.data() == nullptr) return;
    std::string_view rest = appended_.substr(end_);
    for (const std::string_view tag : {"</AppendedData>", "</VTKFile>", ""}) {
      rest.remove_prefix(std::min(rest.find_first_not_of(kXmlBlanks), rest.size()));
      if (!rest.starts_with(tag) || (tag.empty() && !rest.empty())) throw Undeclared("a wrong end behind the data");
      rest.remove_prefix(tag.size());
    }
  }

  VtuValues values(const std::string& section, const std::string& name, std::uint64_t tuples,
                   std::optional<std::uint64_t> components = 1) {
    const Element* const array = find(section, name);
    if (array == nullptr) throw Undeclared("no array " + name);
    if (components && components_of(*array) != *components) throw Undeclared("a wrong number of components");
    const std::uint64_t per_tuple = components_of(*array);
    if (per_tuple == 0 || tuples > kMostBytes / per_tuple) throw Undeclared("too many values");
    const VtuType& type = vtu_type_of(*array);
    VtuValues values =
        array->attribute("format", "ascii") == "ascii" ? text_values(*array, type) : stored_values(*array, type);
    if (values.reals.size() != tuples * per_tuple) throw Undeclared("another number of values");
    return values;
  }

  VtuValues text_values(const Element& array, const VtuType& type) {
    VtuValues values;
    for (Field field : text_fields(array.text)) {
      add_text(type, array.text.substr(field.begin, field.size), values);
      field.begin += place_of(array.text);
      fields_.push_back(field);
    }
    return values;
  }

  [[nodiscard]] std::size_t place_of(std::string_view part) const {
    return static_cast<std::size_t>(part.data() - bytes_.data());
  }

  VtuValues stored_values(const Element& array, const VtuType& type) {
    const std::string bytes = stored_bytes(array, &type);
    if (bytes.size() % type.size != 0) throw Undeclared("a part of a value");
    VtuValues values;
    for (std::size_t i = 0; i < bytes.size(); i += type.size) add_bytes(type, bytes.data() + i, values);
    return values;
  }

  /// The bytes of an array. Notes their fields if the type is given.
  std::string stored_bytes(const Element& array, const VtuType* type) {
    const std::string format = array.attribute("format");
    if (format == "appended") {
      const std::uint64_t offset = array.count("offset");
      if (offset > appended_.size() || tree_.appended.data() == nullptr) throw Undeclared("no such place");
      Stored stored(appended_.substr(offset), is_raw_);
      std::string bytes = unpacked(stored);
      end_ = std::max(end_, offset + stored.position());
      note(place_of(appended_) + offset, stored.position(), is_raw_, type);
      return bytes;
    }
    if (format != "binary") throw Undeclared("an unknown format");
    Stored stored(array.text, false);
    std::string bytes = unpacked(stored);
    if (array.text.find_first_not_of(kXmlBlanks, stored.position()) != std::string_view::npos)
      throw Undeclared("more data than announced");
    const std::size_t begin = std::min(array.text.find_first_not_of(kXmlBlanks), array.text.size());
    note(place_of(array.text) + begin, stored.position() - begin, false, type);
    return bytes;
  }

  void note(std::size_t begin, std::size_t size, bool is_raw, const VtuType* type) {
    if (type == nullptr) return;
    if (!is_raw) {
      fields_.push_back({begin, size, Field::Kind::kBase64});
      return;
    }
    const Field::Kind length = length_bytes_ == 8 ? Field::Kind::kInt64 : Field::Kind::kInt32;
    for (std::size_t i = 0; i < (is_compressed_ ? 4U : 1U); ++i)
      fields_.push_back({begin + i * length_bytes_, length_bytes_, length});
    if (is_compressed_) return;
    for (std::size_t i = length_bytes_; i + type->size <= size; i += type->size)
      fields_.push_back({begin + i, type->size, type->kind});
  }

  [[nodiscard]] std::uint64_t length(Stored& stored) const {
    std::uint64_t value = 0;
    const std::string bytes = stored.take(length_bytes_);
    std::memcpy(&value, bytes.data(), length_bytes_);
    return value;
  }

  [[nodiscard]] static std::string taken(Stored& stored, std::uint64_t size) {
    if (size > stored.most_left()) throw Undeclared("data end early");
    return stored.take(size);
  }

  /// How many bytes are stored, in each block. Notes how many they become.
  [[nodiscard]] std::vector<std::uint64_t> stored_sizes(Stored& stored,
                                                        std::vector<std::uint64_t>* unpacked_sizes = nullptr) const {
    if (!is_compressed_) return {length(stored)};
    const std::uint64_t blocks = length(stored), size = length(stored), last = length(stored);
    if (blocks > stored.most_left()) throw Undeclared("data end early");
    std::vector<std::uint64_t> sizes;
    for (std::uint64_t i = 0; i < blocks; ++i) {
      sizes.push_back(length(stored));
      if (unpacked_sizes != nullptr) unpacked_sizes->push_back(i + 1 == blocks && last != 0 ? last : size);
    }
    return sizes;
  }

  [[nodiscard]] std::string unpacked(Stored& stored) const {
    std::vector<std::uint64_t> unpacked_sizes;
    const std::vector<std::uint64_t> sizes = stored_sizes(stored, &unpacked_sizes);
    if (!is_compressed_) return taken(stored, sizes[0]);
    std::string bytes;
    for (std::size_t i = 0; i < sizes.size(); ++i) bytes += inflated(taken(stored, sizes[i]), unpacked_sizes[i]);
    return bytes;
  }

  static std::string inflated(const std::string& packed, std::uint64_t size) {
    if (size > 2000 * (packed.size() + 1)) throw Undeclared("a block of impossible size");
    std::string bytes(size + 1, '\0');  // one more shows what is longer
    z_stream stream{};
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
    stream.avail_in = static_cast<uInt>(packed.size());
    stream.next_out = reinterpret_cast<Bytef*>(bytes.data());
    stream.avail_out = static_cast<uInt>(bytes.size());
    if (::inflateInit(&stream) != Z_OK) throw Undeclared("zlib does not start");
    const int result = ::inflate(&stream, Z_FINISH);
    const bool is_whole = result == Z_STREAM_END && stream.avail_in == 0 && stream.avail_out == 1;
    ::inflateEnd(&stream);
    if (!is_whole) throw Undeclared("a block that cannot be unpacked");
    bytes.pop_back();
    return bytes;
  }

  template <class T>
  static std::vector<T> integers(const VtuValues& values) {
    if (values.integers.size() != values.reals.size()) throw Undeclared("fractions where there are whole numbers");
    if (values.has_too_large) throw Undeclared("a number out of range");
    std::vector<T> result;
    for (const std::int64_t value : values.integers) {
      if (!std::in_range<T>(value)) throw Undeclared("a number out of range");
      result.push_back(static_cast<T>(value));
    }
    return result;
  }

  void read_points(std::uint64_t points) {
    const std::vector<double> xyz = values("Points", "Points", points, 3).reals;
    for (std::size_t i = 0; i < xyz.size(); i += 3) {
      if (!std::isfinite(xyz[i]) || !std::isfinite(xyz[i + 1]) || xyz[i + 2] != xyz[2])
        throw Undeclared("points that are not in a plane");
      mesh_.points.push_back({xyz[i], xyz[i + 1]});
    }
  }

  void read_point_data(std::uint64_t points) {
    if (find("PointData", "marker") != nullptr)
      mesh_.point_markers = integers<std::int32_t>(values("PointData", "marker", points));
    if (find("PointData", "global_number") != nullptr)
      mesh_.numbers = integers<std::int64_t>(values("PointData", "global_number", points));
    if (find("PointData", "attribute") == nullptr) {
      read_others_on_points(points);
      return;
    }
    mesh_.attributes = values("PointData", "attribute", points, std::nullopt).reals;
    mesh_.attributes_per_point = static_cast<std::int32_t>(components("PointData", "attribute"));
  }

  /// Arrays of other programs, ordered by name, each with a column for each of its components.
  void read_others_on_points(std::uint64_t points) {
    std::set<std::string> names;
    for (const Element& part : piece_->children)
      for (const Element& array : part.children)
        if (part.name == "PointData" && array.name == "DataArray") names.insert(array.attribute("Name"));
    for (const char* known : {"marker", "global_number", "vtkGhostType"}) names.erase(known);
    std::vector<std::vector<double>> rows(points);
    for (const std::string& name : names) {
      if (!fault_of_name(name).empty()) continue;
      const std::vector<double> reals = values("PointData", name, points, std::nullopt).reals;
      const std::uint64_t width = components("PointData", name);
      for (std::uint64_t i = 0; i < reals.size(); ++i) rows[i / width].push_back(reals[i]);
    }
    for (const std::vector<double>& row : rows) mesh_.attributes.insert(mesh_.attributes.end(), row.begin(), row.end());
    mesh_.attributes_per_point = rows.empty() ? 0 : static_cast<std::int32_t>(rows[0].size());
  }

  void read_cells(std::uint64_t cells) {
    const auto types = integers<std::int64_t>(values("Cells", "types", cells));
    const auto ends = integers<std::int64_t>(values("Cells", "offsets", cells));
    const std::int64_t last = ends.empty() ? 0 : ends.back();
    if (last < 0) throw Undeclared("a negative offset");
    const auto corners = integers<std::int32_t>(values("Cells", "connectivity", static_cast<std::uint64_t>(last)));
    std::int64_t begin = 0;
    for (std::size_t cell = 0; cell < types.size(); ++cell) {
      if (types[cell] != 5 && types[cell] != 3) throw Undeclared("neither a triangle nor a line");
      const std::int64_t end = begin + (types[cell] == 5 ? 3 : 2);
      if (ends[cell] != end || end > last) throw Undeclared("an offset that does not fit its cell");
      const std::int32_t* const corner = corners.data() + begin;
      for (std::int64_t i = 0; i < end - begin; ++i)
        if (corner[i] < 0 || static_cast<std::size_t>(corner[i]) >= mesh_.points.size())
          throw Undeclared("no such point");
      if (types[cell] == 5)
        mesh_.triangles.push_back({corner[0], corner[1], corner[2]});
      else
        mesh_.edges.push_back({corner[0], corner[1], 0});
      is_triangle_.push_back(types[cell] == 5);
      begin = end;
    }
  }

  /// The values of the triangles, or of the lines.
  template <class T>
  [[nodiscard]] std::vector<T> of_cells(const std::vector<T>& values, bool of_triangles) const {
    std::vector<T> result;
    for (std::size_t i = 0; i < values.size(); ++i)
      if (is_triangle_[i] == of_triangles) result.push_back(values[i]);
    return result;
  }

  void read_cell_data(std::uint64_t cells) {
    if (find("CellData", "marker") != nullptr) {
      const auto markers = of_cells(integers<std::int32_t>(values("CellData", "marker", cells)), false);
      for (std::size_t e = 0; e < markers.size(); ++e) mesh_.edges[e].marker = markers[e];
    }
    if (find("CellData", "region") != nullptr)
      mesh_.regions = of_cells(values("CellData", "region", cells).reals, true);
    if (find("CellData", "subdomain") != nullptr)
      mesh_.subdomains = of_cells(integers<std::int32_t>(values("CellData", "subdomain", cells)), true);
    if (find("CellData", "rank") != nullptr)
      mesh_.ranks = of_cells(integers<std::int32_t>(values("CellData", "rank", cells)), true);
  }

  std::string_view bytes_;
  Fields& fields_;
  XmlTree tree_;
  const Element* piece_ = nullptr;
  std::string_view appended_;
  bool is_raw_ = false;
  std::size_t end_ = 0;  // end of the appended data that have been read
  std::size_t length_bytes_ = 4;
  bool is_compressed_ = false;
  std::vector<bool> is_triangle_;
  Mesh mesh_;
};

}  // namespace

Mesh declared_vtu(std::string_view bytes, Fields& fields) {
  return VtuFile(bytes, fields).mesh();
}

Mesh declared_pvtu(const Files& files, const std::string& name) {
  Fields ignored;
  const Element root = xml_tree(files.at(name), ignored).root;
  if (root.name != "VTKFile" || root.attribute("type") != "PUnstructuredGrid") throw Undeclared("no grid in pieces");
  const Element& grid = root.only("PUnstructuredGrid");
  std::vector<Mesh> pieces;
  std::set<std::string> seen;
  for (const Element& piece : grid.children) {
    if (piece.name != "Piece") continue;
    const std::string source = piece.attribute("Source");
    if (!files.contains(source) || !seen.insert(source).second) throw Undeclared("no such piece, or one twice");
    VtuFile file(files.at(source), ignored);
    for (const Element& section : grid.children) {
      if (section.name != "PPointData" && section.name != "PCellData") continue;
      for (const Element& array : section.children)
        if (array.name == "PDataArray" &&
            file.components(section.name.substr(1), array.attribute("Name")) !=
                (array.attribute("NumberOfComponents").empty() ? 1 : array.count("NumberOfComponents")))
          throw Undeclared("an array that a piece lacks");
    }
    pieces.push_back(file.mesh());
  }
  if (pieces.empty()) throw Undeclared("no pieces");
  return joined(std::move(pieces));
}

}  // namespace driftmesh::mutants
