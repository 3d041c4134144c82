#include "base/write_at.hpp"

#ifdef _WIN32
#include <io.h>

#include <algorithm>
#include <climits>
#include <mutex>
#else
#include <unistd.h>
#endif

#include <cerrno>

#include "driftmesh/error.hpp"

namespace driftmesh {
namespace {

#ifdef _WIN32
std::int64_t write_some(int file, std::uint64_t place, std::span<const std::byte> bytes) {
  static std::mutex alone;  // a file has one position there
  const std::lock_guard lock(alone);
  if (::_lseeki64(file, static_cast<std::int64_t>(place), SEEK_SET) < 0) return -1;
  return ::_write(file, bytes.data(), static_cast<unsigned>(std::min<std::size_t>(bytes.size(), INT_MAX)));
}
#else
std::int64_t write_some(int file, std::uint64_t place, std::span<const std::byte> bytes) {
  return ::pwrite(file, bytes.data(), bytes.size(), static_cast<off_t>(place));
}
#endif

}  // namespace

void write_at(int file, std::uint64_t place, std::span<const std::byte> bytes, const std::string& path,
              const char* what) {
  while (!bytes.empty()) {
    errno = 0;
    const std::int64_t written = write_some(file, place, bytes);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) throw FileError(path, what);
    bytes = bytes.subspan(static_cast<std::size_t>(written));
    place += static_cast<std::uint64_t>(written);
  }
}

}  // namespace driftmesh
