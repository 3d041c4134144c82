#include "base/write_at.hpp"

#include <unistd.h>

#include <cerrno>

#include "driftmesh/error.hpp"

namespace driftmesh {

void write_at(int file, std::uint64_t place, std::span<const std::byte> bytes, const std::string& path,
              const char* what) {
  while (!bytes.empty()) {
    errno = 0;
    const ssize_t written = ::pwrite(file, bytes.data(), bytes.size(), static_cast<off_t>(place));
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) throw FileError(path, what);
    bytes = bytes.subspan(static_cast<std::size_t>(written));
    place += static_cast<std::uint64_t>(written);
  }
}

}  // namespace driftmesh
