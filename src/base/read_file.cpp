#include "base/read_file.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <utility>

#include "base/huge_pages.hpp"
#include "base/standard_streams.hpp"
#include "driftmesh/error.hpp"

namespace driftmesh {
namespace {

struct CloseFile {
  void operator()(std::FILE* file) const {
    if (file != stdin) std::fclose(file);
  }
};
using OpenFile = std::unique_ptr<std::FILE, CloseFile>;

constexpr std::size_t kChunkBytes = std::size_t{1} << 20;

// The size according to the file system; 0 for a pipe. Only a hint: the file may change while it is read.
std::size_t expected_size(const std::string& path) {
  std::error_code failed;
  const auto size = std::filesystem::file_size(path, failed);
  return failed ? 0 : static_cast<std::size_t>(size);
}

OpenFile standard_input() {
  static bool taken = false;
  if (std::exchange(taken, true))
    throw InputError({"-"}, "standard input can be read only once", "name a file for one of the two");
  return OpenFile(stdin);
}

/// Whether the name is one that a shell gives to a pipe, which somebody has opened at its other end.
bool is_given_by_shell(const std::string& path) {
  return path.starts_with("/dev/fd/") || path.starts_with("/proc/self/fd/") || path == "/dev/stdin";
}

struct stat status_of(const std::string& path) {
  struct stat status {};
  errno = 0;
  if (::stat(path.c_str(), &status) != 0) throw FileError(path, "cannot open");
  return status;
}

bool is_stream(const std::string& path) {
  return is_standard_stream(path) || (is_given_by_shell(path) && S_ISFIFO(status_of(path).st_mode));
}

OpenFile open_file(const std::string& path) {
  if (is_standard_stream(path)) return standard_input();
  if (!is_stream(path)) require_regular_file(path);
  errno = 0;
  OpenFile file(std::fopen(path.c_str(), "rb"));
  if (!file) throw FileError(path, "cannot open");
  return file;
}

/// Checks what comes in from a stream, whose end nobody knows.
class StreamGuard {
 public:
  StreamGuard(const std::string& path, std::string_view first) : path_(path), first_(first) {}

  void check(std::string_view bytes) {
    if (bytes.size() > kMost)
      throw InputError({path_}, "has more than " + std::to_string(kMost >> 20) + " MB, a quarter of the memory here",
                       "write it to a file, and name that");
    if (begun_) return;
    const std::size_t begin = bytes.find_first_not_of(" \t\r\n\v\f");
    if (begin == std::string_view::npos) return;
    begun_ = true;
    if (!first_.empty() && first_.find(bytes[begin]) == std::string_view::npos)
      throw InputError({path_}, "does not begin like a file of this format",
                       "an extension tells the format of a stream, as in -.geojson");
  }

 private:
  static inline const std::size_t kMost =
      static_cast<std::size_t>(::sysconf(_SC_PHYS_PAGES)) / 4 * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
  const std::string& path_;
  std::string_view first_;
  bool begun_ = false;
};

}  // namespace

void require_regular_file(const std::string& path) {
  const mode_t mode = status_of(path).st_mode;
  if (!S_ISREG(mode))
    throw InputError({path},
                     S_ISDIR(mode)    ? "is a folder, not a file"
                     : S_ISFIFO(mode) ? "is a pipe, not a file"
                     : S_ISSOCK(mode) ? "is a socket, not a file"
                                      : "is a device, not a file",
                     "name a file, or - for standard input");
  errno = 0;
  if (::access(path.c_str(), R_OK) != 0) throw FileError(path, "cannot open");
}

std::string read_file(const std::string& path, std::string_view first) {
  const bool streams = is_stream(path);
  StreamGuard guard(path, first);
  const OpenFile file = open_file(path);
  std::setvbuf(file.get(), nullptr, _IONBF, 0);
  std::string bytes;
  std::size_t used = 0;
  std::size_t wanted = streams ? kChunkBytes : expected_size(path) + 1;  // one more, to see the end in the first round
  while (true) {
    reserve_in_huge_pages(bytes, used + wanted);
    bytes.resize(used + wanted);
    errno = 0;
    const std::size_t got = std::fread(bytes.data() + used, 1, wanted, file.get());
    used += got;
    if (std::ferror(file.get()) != 0) throw FileError(file.get() == stdin ? "standard input" : path, "cannot read");
    if (streams) guard.check(std::string_view(bytes).substr(0, used));
    if (got < wanted) break;
    wanted = kChunkBytes + used / 2;
  }
  bytes.resize(used);
  return bytes;
}

}  // namespace driftmesh
