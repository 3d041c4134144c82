#include "base/read_file.hpp"

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

OpenFile open_file(const std::string& path) {
  if (is_standard_stream(path)) return standard_input();
  errno = 0;
  OpenFile file(std::fopen(path.c_str(), "rb"));
  if (!file) throw FileError(path, "cannot open");
  return file;
}

}  // namespace

std::string read_file(const std::string& path) {
  const OpenFile file = open_file(path);
  std::setvbuf(file.get(), nullptr, _IONBF, 0);
  std::string bytes;
  std::size_t used = 0;
  std::size_t wanted = expected_size(path) + 1;  // one more, so that the end is seen in the first round
  while (true) {
    reserve_in_huge_pages(bytes, used + wanted);
    bytes.resize(used + wanted);
    errno = 0;
    const std::size_t got = std::fread(bytes.data() + used, 1, wanted, file.get());
    used += got;
    if (std::ferror(file.get()) != 0) throw FileError(file.get() == stdin ? "standard input" : path, "cannot read");
    if (got < wanted) break;
    wanted = kChunkBytes + used / 2;
  }
  bytes.resize(used);
  return bytes;
}

}  // namespace driftmesh
