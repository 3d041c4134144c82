#include "base/read_file.hpp"

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "base/error.hpp"

namespace driftmesh {
namespace {

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

constexpr std::size_t kChunkBytes = std::size_t{1} << 20;

// What the file system says; 0 for a pipe. A hint only: the file may change while it is read.
std::size_t expected_size(const std::string& path) {
  std::error_code failed;
  const auto size = std::filesystem::file_size(path, failed);
  return failed ? 0 : static_cast<std::size_t>(size);
}

}  // namespace

std::string read_file(const std::string& path) {
  errno = 0;
  const std::unique_ptr<std::FILE, CloseFile> file(std::fopen(path.c_str(), "rb"));
  if (!file) throw FileError(path, "cannot open");
  std::setvbuf(file.get(), nullptr, _IONBF, 0);
  std::string bytes;
  std::size_t used = 0;
  std::size_t wanted = expected_size(path) + 1;  // one more, so that the end is seen in the first round
  while (true) {
    bytes.resize(used + wanted);
    errno = 0;
    const std::size_t got = std::fread(bytes.data() + used, 1, wanted, file.get());
    used += got;
    if (std::ferror(file.get()) != 0) throw FileError(path, "cannot read");
    if (got < wanted) break;
    wanted = kChunkBytes + used / 2;
  }
  bytes.resize(used);
  return bytes;
}

}  // namespace driftmesh
