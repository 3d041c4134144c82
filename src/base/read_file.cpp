#include "base/read_file.hpp"

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <system_error>
#include <utility>

#include "base/huge_pages.hpp"
#include "base/standard_streams.hpp"
#include "base/system.hpp"
#include "driftmesh/error.hpp"

namespace driftmesh {
namespace {

namespace fs = std::filesystem;

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

fs::file_type type_of(const std::string& path) {
  std::error_code failed;
  const fs::file_type type = fs::status(path, failed).type();
  if (type != fs::file_type::none && type != fs::file_type::not_found) return type;
  errno = failed.default_error_condition().value();
  throw FileError(path, "cannot open");
}

bool is_stream(const std::string& path) {
  return is_standard_stream(path) || (is_given_by_shell(path) && type_of(path) == fs::file_type::fifo);
}

OpenFile opened(const std::string& path) {
  errno = 0;
  OpenFile file(std::fopen(path.c_str(), "rb"));
  if (!file) throw FileError(path, "cannot open");
  return file;
}

OpenFile open_file(const std::string& path) {
  if (is_standard_stream(path)) return standard_input();
  if (!is_stream(path)) require_regular_file(path);
  return opened(path);
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
  static inline const std::uint64_t kMost = memory_of_machine() / 4;
  const std::string& path_;
  std::string_view first_;
  bool begun_ = false;
};

}  // namespace

void require_regular_file(const std::string& path) {
  const fs::file_type type = type_of(path);
  if (type != fs::file_type::regular)
    throw InputError({path},
                     type == fs::file_type::directory ? "is a folder, not a file"
                     : type == fs::file_type::fifo    ? "is a pipe, not a file"
                     : type == fs::file_type::socket  ? "is a socket, not a file"
                                                      : "is a device, not a file",
                     "name a file, or - for standard input");
  opened(path);
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
