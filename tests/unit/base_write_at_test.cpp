#include <doctest/doctest.h>
#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <span>
#include <string>

#include "base/read_file.hpp"
#include "base/write_at.hpp"
#include "driftmesh/error.hpp"
#include "temporary_folder.hpp"

using namespace driftmesh;

namespace {

std::span<const std::byte> bytes_of(const std::string& text) {
  return std::as_bytes(std::span(text));
}

/// Closed when the test ends.
class OpenFile {
 public:
  explicit OpenFile(const std::string& path) : file_(::open(path.c_str(), O_CREAT | O_WRONLY, 0600)) {}
  ~OpenFile() { ::close(file_); }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;
  [[nodiscard]] int number() const { return file_; }

 private:
  int file_;
};

/// This process can make no file longer than that, while the object exists. What fits of a write is written.
class FileLimit {
 public:
  explicit FileLimit(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit now{bytes, before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &now);
  }
  ~FileLimit() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  FileLimit(const FileLimit&) = delete;
  FileLimit& operator=(const FileLimit&) = delete;

 private:
  void (*handler_)(int);
  rlimit before_{};
};

}  // namespace

TEST_CASE("bytes are written at their place, in any order") {
  const TemporaryFolder folder;
  const std::string path = (folder.path() / "file").string();
  const OpenFile file(path);
  write_at(file.number(), 6, bytes_of("world"), path);
  write_at(file.number(), 0, bytes_of("hello "), path);
  write_at(file.number(), 2, {}, path);
  CHECK(read_file(path) == "hello world");
}

TEST_CASE("what does not fit is an error with the file, what failed and the reason, after what fits") {
  const TemporaryFolder folder;
  const std::string path = (folder.path() / "file").string();
  const OpenFile file(path);
  {
    const FileLimit limit(1000);
    CHECK_THROWS_WITH_AS(write_at(file.number(), 500, bytes_of(std::string(700, 'x')), path, "cannot keep"),
                         (path + ": cannot keep: File too large").c_str(), FileError);
  }
  CHECK(std::filesystem::file_size(path) == 1000);
  CHECK_THROWS_WITH_AS(write_at(-1, 0, bytes_of("x"), path), (path + ": cannot write: Bad file descriptor").c_str(),
                       FileError);
}
