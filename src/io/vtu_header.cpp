#include "io/vtu_header.hpp"

#include <algorithm>
#include <charconv>

#include "driftmesh/error.hpp"
#include "io/byte_cursor.hpp"
#include "io/read_checks.hpp"
#include "io/vtu_format.hpp"
#include "io/xml_scanner.hpp"

namespace driftmesh {
namespace {

constexpr std::string_view kZlib = "vtkZLibDataCompressor";

bool is_blank_text(std::string_view text) {
  return std::all_of(text.begin(), text.end(), ByteCursor::is_blank);
}

class VtuHeaderParser {
 public:
  VtuHeaderParser(const std::string& file, std::string_view bytes)
      : file_(file), bytes_(bytes), scanner_(file, bytes) {}

  VtuHeader parse() {
    XmlTag tag;
    while (scanner_.next(tag)) {
      if (is_complete_) fail(tag, "has more behind </VTKFile>", kDamaged);
      take_text(tag);
      if (tag.name == "AppendedData") return enter_appended_data(tag);
      if (tag.opens) enter(tag);
      if (tag.closes) leave(tag);
    }
    if (!is_complete_) throw InputError({file_, 0}, "ends before </VTKFile>", kDamaged);
    if (!is_blank_text(bytes_.substr(end_))) throw InputError({file_, 0}, "has more behind </VTKFile>", kDamaged);
    require_piece(tag);
    require_no_appended_arrays();
    return std::move(header_);
  }

 private:
  void enter(const XmlTag& tag) {
    if (tag.name == "VTKFile" && tag.parents.empty()) read_file_tag(tag);
    if (tag.name == "Piece" && lies_in(tag, kGrid)) read_piece_tag(tag);
    if (is_array(tag.name)) read_array_tag(tag);
  }

  void leave(const XmlTag& tag) {
    if (tag.parents.empty()) is_complete_ = true, end_ = scanner_.position();
    if (is_array(tag.name)) open_ = nullptr;
  }

  using Path = std::vector<std::string_view>;
  static inline const Path kGrid{"VTKFile", "UnstructuredGrid"};

  static bool lies_in(const XmlTag& tag, const Path& path) { return tag.parents == path; }
  static bool is_array(std::string_view name) { return name == "DataArray" || name == "Array"; }

  static std::string section_of_names(std::string_view what) {
    if (what == kMarkerOfName) return VtuHeader::kMarkerNames;
    if (what == kRegionOfName) return VtuHeader::kRegionNames;
    if (what == kAttributeOfName) return VtuHeader::kAttributeNames;
    return what == kCoordinatesOfName ? VtuHeader::kCoordinates : "";
  }

  /// Section of the piece (PointData, CellData, Points, Cells) or, in the field data, the kind of names; empty for all
  /// that a mesh has no place for.
  static std::string section_of(const XmlTag& tag) {
    if (lies_in(tag, {"VTKFile", "UnstructuredGrid", "FieldData"}) && tag.attribute("ComponentName1") == "dimension")
      return section_of_names(tag.attribute("ComponentName0"));
    for (const std::string_view section : {"PointData", "CellData", "Points", "Cells"})
      if (lies_in(tag, {"VTKFile", "UnstructuredGrid", "Piece", section})) return std::string(section);
    return "";
  }

  /// The text of an array, which may stand before or behind elements with information about it.
  void take_text(const XmlTag& tag) {
    if (tag.before.empty() || (open_ != nullptr && !is_array(tag.around_text()))) return;
    if (open_ == nullptr) fail(tag, "has text between its elements", kDamaged);
    if (!open_->text.empty()) fail(tag, "has a DataArray in two parts", kDamaged);
    open_->text = tag.before;
  }

  void read_file_tag(const XmlTag& tag) {
    if (tag.attribute("type") != "UnstructuredGrid") fail(tag, "is not of type UnstructuredGrid", kSaveVtuAs);
    if (tag.attribute("byte_order", "LittleEndian") != "LittleEndian") fail(tag, "is big-endian", kSaveVtuAs);
    const std::string compressor(tag.attribute("compressor"));
    if (!compressor.empty() && compressor != kZlib) fail(tag, "is compressed by " + compressor, kSaveVtuAs);
    header_.compressed = !compressor.empty();
    const std::string_view lengths = tag.attribute("header_type", "UInt32");
    if (lengths != "UInt32" && lengths != "UInt64") fail(tag, "has an unknown header_type", kSaveVtuAs);
    header_.wide_lengths = lengths == "UInt64";
    seen_file_ = true;
  }

  void read_piece_tag(const XmlTag& tag) {
    if (!seen_file_) fail(tag, "is not a VTK file", kSaveVtuAs);
    if (seen_piece_) fail(tag, "has more than one Piece", "merge the pieces first");
    seen_piece_ = true;
    header_.points = count(tag, "NumberOfPoints");
    header_.cells = count(tag, "NumberOfCells");
  }

  void read_array_tag(const XmlTag& tag) {
    VtuHeader::Array array;
    array.type = tag.attribute("type");
    array.components = tag.attribute("NumberOfComponents").empty() ? 1 : count(tag, "NumberOfComponents");
    array.line = tag.line;
    array.format = format_of(tag);
    if (array.format == VtuHeader::Format::kAppended) array.offset = count(tag, "offset");
    VtuHeader::Array* place = nullptr;
    const std::string section = section_of(tag);
    if (section.empty()) {
      place = &header_.other_arrays.emplace_back(std::move(array));
    } else {
      const std::string name = section == "Points" ? "Points" : std::string(tag.attribute("Name"));
      const auto [entry, is_new] = header_.arrays.try_emplace({section, name}, std::move(array));
      if (!is_new) fail(tag, "has two arrays '" + name + "' in <" + section + ">", "keep one of them");
      place = &entry->second;
    }
    open_ = tag.closes ? nullptr : place;
  }

  VtuHeader::Format format_of(const XmlTag& tag) const {
    const std::string_view format = tag.attribute("format", "ascii");  // as VTK has it
    if (format == "appended") return VtuHeader::Format::kAppended;
    if (format == "binary") return VtuHeader::Format::kBinary;
    if (format != "ascii") fail(tag, "has a DataArray of format '" + std::string(format) + "'", kSaveVtuAs);
    return VtuHeader::Format::kAscii;
  }

  VtuHeader enter_appended_data(const XmlTag& tag) {
    require_piece(tag);
    if (!lies_in(tag, {"VTKFile"})) fail(tag, "has <AppendedData> inside of its grid", kDamaged);
    const std::string_view encoding = tag.attribute("encoding");
    if (encoding != "raw" && encoding != "base64")
      fail(tag, "has appended data of encoding '" + std::string(encoding) + "'", kSaveVtuAs);
    header_.raw = encoding == "raw";
    ByteCursor data(file_, bytes_.substr(scanner_.position()));
    data.skip_blanks();
    if (!data.rest().starts_with('_')) fail(tag, "has no '_' at the start of its data", kDamaged);
    header_.appended = data.rest().substr(1);
    return std::move(header_);
  }

  void require_piece(const XmlTag& tag) const {
    if (!seen_piece_) fail(tag, seen_file_ ? "has no Piece" : "is not a VTK file", kSaveVtuAs);
  }

  void require_no_appended_arrays() const {
    for (const auto& [name, array] : header_.arrays)
      if (array.format == VtuHeader::Format::kAppended)
        throw InputError({file_, array.line}, "has no AppendedData section for its array '" + name.second + "'",
                         kDamaged);
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
    throw InputError({file_, tag.line}, what, next);
  }

  const std::string& file_;
  std::string_view bytes_;
  XmlScanner scanner_;
  VtuHeader header_;
  VtuHeader::Array* open_ = nullptr;  // the scanner is in its element
  bool seen_file_ = false;
  bool seen_piece_ = false;
  bool is_complete_ = false;
  std::size_t end_ = 0;  // where </VTKFile> ends
};

}  // namespace

VtuHeader parse_vtu_header(const std::string& file, std::string_view bytes) {
  return VtuHeaderParser(file, bytes).parse();
}

}  // namespace driftmesh
