#include "io/vtu_header.hpp"

#include <algorithm>
#include <charconv>

#include "driftmesh/error.hpp"
#include "io/byte_cursor.hpp"
#include "io/read_checks.hpp"
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
    if (tag.name == "VTKFile") read_file_tag(tag);
    if (tag.name == "Piece") read_piece_tag(tag);
    if (is_section(tag.name)) section_ = tag.name;
    if (tag.name == "DataArray" || tag.name == "Array") read_array_tag(tag);
    if (!tag.closes && open_ != nullptr && tag.name != "DataArray" && tag.name != "Array") ++depth_;
  }

  void leave(const XmlTag& tag) {
    if (tag.name == "VTKFile") is_complete_ = true, end_ = scanner_.position();
    if (is_section(tag.name)) section_.clear();
    if (tag.name == "DataArray" || tag.name == "Array")
      open_ = nullptr;
    else if (!tag.opens && depth_ > 0)
      --depth_;
  }

  static bool is_section(std::string_view name) {
    return name == "PointData" || name == "CellData" || name == "Points" || name == "Cells";
  }

  /// The text of an array, which may stand before or behind elements with information about it.
  void take_text(const XmlTag& tag) {
    if (open_ == nullptr || depth_ > 0 || is_blank_text(tag.before)) return;
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
    if (section_.empty()) {  // field data
      place = &header_.other_arrays.emplace_back(std::move(array));
    } else {
      const std::string name = section_ == "Points" ? "Points" : std::string(tag.attribute("Name"));
      const auto [entry, is_new] = header_.arrays.try_emplace({section_, name}, std::move(array));
      if (!is_new) fail(tag, "has two arrays '" + name + "' in <" + section_ + ">", "keep one of them");
      place = &entry->second;
    }
    open_ = tag.closes ? nullptr : place;
    depth_ = 0;
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
    const std::string_view encoding = tag.attribute("encoding");
    if (encoding != "raw" && encoding != "base64")
      fail(tag, "has appended data of encoding '" + std::string(encoding) + "'", kSaveVtuAs);
    header_.raw = encoding == "raw";
    const std::size_t underscore = bytes_.find('_', scanner_.position());
    if (underscore == std::string_view::npos) fail(tag, "ends before its data", kDamaged);
    header_.appended = bytes_.substr(underscore + 1);
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
  std::string section_;
  VtuHeader::Array* open_ = nullptr;  // whose element the scanner is in
  int depth_ = 0;                     // of elements in it
  bool seen_file_ = false;
  bool seen_piece_ = false;
  bool is_complete_ = false;
  std::size_t end_ = 0;  // of </VTKFile>
};

}  // namespace

VtuHeader parse_vtu_header(const std::string& file, std::string_view bytes) {
  return VtuHeaderParser(file, bytes).parse();
}

}  // namespace driftmesh
