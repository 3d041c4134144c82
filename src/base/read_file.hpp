#pragma once

#include <string>
#include <string_view>

namespace driftmesh {

/// Throws FileError unless there is such a file and it may be read, and InputError for a folder, a device, a socket, or
/// a pipe: these could keep a reader waiting, or never end.
void require_regular_file(const std::string& path);

/// All bytes of a file, or of standard input (see is_standard_stream), which can be read only once; also of a pipe that
/// the shell has opened (/dev/fd/63). What streams is given up as soon as it does not begin, after blanks, with one of
/// the characters of `first` (any, if it is empty), and beyond a quarter of the machine's memory. Throws FileError that
/// names the file and the system's reason; InputError likewise, for what require_regular_file refuses, and for reading
/// standard input again.
[[nodiscard]] std::string read_file(const std::string& path, std::string_view first = {});

// Characters that formats begin with, after blanks and a byte order mark.
inline constexpr std::string_view kBeginsJson = "{[\xEF";
inline constexpr std::string_view kBeginsXml = "<\xEF";
inline constexpr std::string_view kBeginsNumbers = "#+-.0123456789\xEF";

}  // namespace driftmesh
