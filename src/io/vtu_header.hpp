#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace driftmesh {

/// What to do about a .vtu that cannot be read as it is.
inline constexpr const char* kSaveVtuAs =
    "save it as a .vtu of one piece in little-endian byte order, uncompressed or compressed by zlib";

/// What the XML of a .vtu says, and where its data are.
struct VtuHeader {
  enum class Format {
    kAppended,  ///< in the section behind the grid, from `offset` on
    kBinary,    ///< in the text of the element, as base64
    kAscii,     ///< in the text of the element
  };
  struct Array {
    Format format = Format::kAppended;
    std::string type;  ///< VTK's name: "Float64"
    std::uint64_t components = 1;
    std::uint64_t offset = 0;  ///< kAppended: in the characters of the section
    std::string_view text;     ///< otherwise: of the element
    std::size_t line = 0;
  };
  using Name = std::pair<std::string, std::string>;  ///< section (PointData, ...) and name
  // The sections of arrays in the field data that name something.
  static constexpr const char* kMarkerNames = "FieldData of markers";
  static constexpr const char* kRegionNames = "FieldData of regions";
  static constexpr const char* kAttributeNames = "FieldData of attributes";
  static constexpr const char* kCoordinates = "FieldData of coordinates";

  std::uint64_t points = 0;
  std::uint64_t cells = 0;
  bool wide_lengths = false;        ///< lengths in the data are UInt64, not UInt32
  bool compressed = false;          ///< by zlib
  bool raw = false;                 ///< appended data are bytes, not base64
  std::map<Name, Array> arrays;     ///< on points and cells, and names
  std::vector<Array> other_arrays;  ///< arrays that only take up room
  std::string_view appended;        ///< the section, from behind its '_' to the end of the file
};

/// Reads the XML of a .vtu. Views refer to `bytes`. Errors: InputError for what is damaged or cannot be read.
[[nodiscard]] VtuHeader parse_vtu_header(const std::string& file, std::string_view bytes);

}  // namespace driftmesh
