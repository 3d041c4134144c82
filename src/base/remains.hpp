#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace driftmesh {

/// Between the name that a temporary file will have and whose it is.
inline constexpr std::string_view kTemporaryMark = ".tmp-";

/// The process that a temporary file belongs to, by its name (see temporary_name()).
struct FileOwner {
  std::string host;  ///< as host_of_processes() has it there
  long process = 0;
  friend bool operator==(const FileOwner&, const FileOwner&) = default;
};
/// Nothing for any other name, also for one like it whose host says nothing of where its processes are.
[[nodiscard]] std::optional<FileOwner> owner_in(std::string_view name);

/// A temporary file, and what is known of its process.
struct Remains {
  std::string path;
  FileOwner owner;
  std::uint64_t bytes = 0;
  double quiet = 0;        ///< seconds since it was last written to
  bool is_here = false;    ///< its process is, or was, of this host
  bool has_ended = false;  ///< known of those of this host alone
};
/// All in a folder, by their names; what cannot be read is left out.
[[nodiscard]] std::vector<Remains> temporaries_in(const std::string& folder);

/// What nobody writes to for so many seconds is that of a run that has ended, if nothing else is known of it.
inline constexpr double kAbandoned = 24 * 3600;

/// Whether nobody will ever finish it: its process has ended, or is another host's and has been quiet for that long.
[[nodiscard]] inline bool is_abandoned(const Remains& file, double after = kAbandoned) {
  return file.is_here ? file.has_ended : file.quiet >= after;
}

}  // namespace driftmesh
