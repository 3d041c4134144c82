#include "base/atomic_file.hpp"

#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <filesystem>

#include "base/standard_streams.hpp"
#include "driftmesh/error.hpp"

namespace driftmesh {
namespace {

constexpr std::size_t kBufferBytes = std::size_t{1} << 20;

std::string follow_links(const std::string& path) {
  std::error_code ignored;
  if (!std::filesystem::is_symlink(path, ignored)) return path;
  const auto resolved = std::filesystem::weakly_canonical(path, ignored);
  return ignored ? path : resolved.string();
}

// Renaming over a device or a pipe would replace it by a plain file.
bool must_write_directly(const std::string& target) {
  std::error_code ignored;
  const auto status = std::filesystem::status(target, ignored);
  return std::filesystem::exists(status) && !std::filesystem::is_regular_file(status) &&
         !std::filesystem::is_directory(status);
}

// Unique in this process by the counter and among processes of this machine by the process id; opened
// exclusively, so a clash with another machine on a shared folder is an error and not a mixed file.
std::string temporary_name(const std::string& target) {
  static std::atomic<unsigned> counter{0};
  return target + ".tmp-" + std::to_string(::getpid()) + "-" + std::to_string(counter++);
}

std::FILE* open_standard_output() {
  if (!take_standard_output())
    throw InputError({"-"}, "standard output can hold only one file", "give the others a name");
  if (::write(STDOUT_FILENO, "", 0) == -1) return nullptr;  // it is closed
  const int copy = ::dup(STDOUT_FILENO);
  return copy == -1 ? nullptr : ::fdopen(copy, "wb");
}

}  // namespace

AtomicFile::AtomicFile(const std::string& path)
    : path_(is_standard_stream(path) ? "standard output" : path), target_(follow_links(path)) {
  errno = 0;
  if (is_standard_stream(path))
    stream_ = open_standard_output();
  else
    open();
  if (stream_ == nullptr) fail("cannot write");
  buffer_ = std::make_unique<char[]>(kBufferBytes);
  std::setvbuf(stream_, buffer_.get(), _IOFBF, kBufferBytes);
}

void AtomicFile::open() {
  std::error_code ignored;
  if (std::filesystem::is_directory(target_, ignored)) {
    errno = EISDIR;
    fail("cannot write");
  }
  if (must_write_directly(target_)) {
    stream_ = std::fopen(target_.c_str(), "wb");
  } else {
    temporary_ = temporary_name(target_);
    noted_.emplace(temporary_);
    stream_ = std::fopen(temporary_.c_str(), "wbx");
    if (stream_ == nullptr) {  // it may be somebody else's
      noted_.reset();
      temporary_.clear();
    }
  }
}

AtomicFile::~AtomicFile() {
  close_and_remove();
}

void AtomicFile::write(const void* bytes, std::size_t count) {
  if (count == 0) return;
  errno = 0;
  if (std::fwrite(bytes, 1, count, stream_) != count) fail("cannot write");
  size_ += count;
}

void AtomicFile::commit() {
  errno = 0;
  std::FILE* const stream = stream_;
  stream_ = nullptr;
  if (std::fclose(stream) != 0) fail("cannot write");
  if (!temporary_.empty() && std::rename(temporary_.c_str(), target_.c_str()) != 0) fail("cannot rename to");
  temporary_.clear();
  noted_.reset();
}

void AtomicFile::fail(const char* what) {
  const int reason = errno;
  close_and_remove();
  errno = reason;
  throw FileError(path_, what);
}

void AtomicFile::close_and_remove() noexcept {
  if (stream_ != nullptr) std::fclose(stream_);
  stream_ = nullptr;
  if (!temporary_.empty()) std::remove(temporary_.c_str());
  temporary_.clear();
  noted_.reset();
}

}  // namespace driftmesh
