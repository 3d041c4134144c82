#include "base/atomic_file.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <tuple>
#include <utility>

#include "base/file_identity.hpp"
#include "base/staged_files.hpp"
#include "base/standard_streams.hpp"
#include "driftmesh/error.hpp"

namespace driftmesh {
namespace {

constexpr std::size_t kBufferBytes = std::size_t{1} << 20;
constexpr std::size_t kUnbuffered = kBufferBytes / 2;
constexpr std::size_t kAtOnce = 8 * kBufferBytes;  // so that the disk can begin

// Renaming over a device or a pipe would replace it by a plain file.
bool must_write_directly(const std::string& target) {
  std::error_code ignored;
  const auto status = std::filesystem::status(target, ignored);
  return std::filesystem::exists(status) && !std::filesystem::is_regular_file(status) &&
         !std::filesystem::is_directory(status);
}

// As far as this process may.
void hand_on_permissions(std::FILE* to, const std::string& target) {
  struct stat old {};
  if (::stat(target.c_str(), &old) != 0) return;
  std::ignore = ::fchown(::fileno(to), old.st_uid, old.st_gid);
  std::ignore = ::fchmod(::fileno(to), old.st_mode & (S_IRWXU | S_IRWXG | S_IRWXO));
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
    : path_(is_standard_stream(path) ? "standard output" : path), target_(link_target(path)) {
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
  struct stat found {};
  if (::stat(target_.c_str(), &found) != 0 && errno == ENAMETOOLONG) fail("cannot write");
  if (S_ISDIR(found.st_mode)) {
    errno = EISDIR;
    fail("cannot write");
  }
  errno = 0;
  if (must_write_directly(target_)) {
    stream_ = std::fopen(target_.c_str(), "wb");
  } else {
    remove_remains_beside(target_);
    temporary_ = temporary_name(target_);
    noted_ = std::make_unique<NotedTemporary>(temporary_);
    // Opened exclusively: a clash with another machine on a shared folder is an error and not a mixed file.
    stream_ = std::fopen(temporary_.c_str(), "wbx");
    if (stream_ == nullptr) {  // it may be somebody else's
      noted_.reset();
      temporary_.clear();
    } else {
      hand_on_permissions(stream_, target_);
    }
  }
}

AtomicFile::~AtomicFile() {
  close_and_remove();
}

void AtomicFile::write(const void* bytes, std::size_t count) {
  if (count == 0) return;
  errno = 0;
  if (count >= kUnbuffered)
    write_large(static_cast<const char*>(bytes), count);
  else if (std::fwrite(bytes, 1, count, stream_) != count)
    fail("cannot write");
  size_ += count;
}

/// Behind what is in the buffer.
void AtomicFile::write_large(const char* bytes, std::size_t count) {
  if (std::fflush(stream_) != 0) fail("cannot write");
  const int file = ::fileno(stream_);
  for (std::size_t done = 0; done < count;) {
    const ssize_t now = ::write(file, bytes + done, std::min(count - done, kAtOnce));
    if (now < 0 && errno == EINTR) continue;
    if (now <= 0) fail("cannot write");
    behind_.wrote(file, size_ + done, static_cast<std::size_t>(now));
    done += static_cast<std::size_t>(now);
  }
}

const std::string& AtomicFile::name_meanwhile() const {
  if (temporary_.empty()) throw InputError({path_}, "is no regular file, which this format needs", "name another file");
  return temporary_;
}

void AtomicFile::commit() {
  errno = 0;
  std::FILE* const stream = stream_;
  stream_ = nullptr;
  if (std::fclose(stream) != 0) fail("cannot write");
  if (temporary_.empty()) return;
  std::error_code unknown;  // others may have written it by name
  size_ = std::max<std::uint64_t>(size_, std::filesystem::file_size(temporary_, unknown));
  StagedFiles alone;
  StagedFiles::File staged{{path_, size_}, target_, std::exchange(temporary_, {}), std::move(noted_), {}};
  alone.take(std::move(staged));
  alone.commit();
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
