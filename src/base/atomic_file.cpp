#include "base/atomic_file.hpp"

#ifndef DRIFTMESH_PORTABLE
#include <sys/stat.h>
#include <unistd.h>
#endif

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <system_error>
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

namespace fs = std::filesystem;

// Renaming over a device or a pipe would replace it by a plain file.
bool must_write_directly(const std::string& target) {
  std::error_code ignored;
  const auto status = fs::status(target, ignored);
  return fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status);
}

#ifdef DRIFTMESH_PORTABLE

void hand_on_permissions(std::FILE*, const std::string& name, const std::string& target) {
  std::error_code ignored;
  if (const auto old = fs::status(target, ignored); fs::exists(old)) fs::permissions(name, old.permissions(), ignored);
}

std::FILE* copy_of_standard_output() {
  return stdout;
}

std::size_t write_some(std::FILE* stream, WriteBehind&, std::uint64_t, const char* bytes, std::size_t count) {
  return std::fwrite(bytes, 1, count, stream);
}

#else

/// From a file to the one that will replace it, open as `to`, of that name. As far as this process may.
void hand_on_permissions(std::FILE* to, const std::string&, const std::string& target) {
  struct stat old {};
  if (::stat(target.c_str(), &old) != 0) return;
  std::ignore = ::fchown(::fileno(to), old.st_uid, old.st_gid);
  std::ignore = ::fchmod(::fileno(to), old.st_mode & (S_IRWXU | S_IRWXG | S_IRWXO));
}

std::FILE* copy_of_standard_output() {
  if (::write(STDOUT_FILENO, "", 0) == -1) return nullptr;  // it is closed
  const int copy = ::dup(STDOUT_FILENO);
  return copy == -1 ? nullptr : ::fdopen(copy, "wb");
}

/// Writes at the end of a stream, which is at this place, without a copy, and returns how many bytes; 0 if that fails.
std::size_t write_some(std::FILE* stream, WriteBehind& behind, std::uint64_t place, const char* bytes,
                       std::size_t count) {
  const int file = ::fileno(stream);
  ssize_t written = -1;
  do written = ::write(file, bytes, count);
  while (written < 0 && errno == EINTR);
  if (written <= 0) return 0;
  behind.wrote(file, place, static_cast<std::size_t>(written));
  return static_cast<std::size_t>(written);
}

#endif

std::FILE* open_standard_output() {
  if (!take_standard_output())
    throw InputError({"-"}, "standard output can hold only one file", "give the others a name");
  return copy_of_standard_output();
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
  buffer_ = std::make_unique_for_overwrite<char[]>(kBufferBytes);
  std::setvbuf(stream_, buffer_.get(), _IOFBF, kBufferBytes);
}

void AtomicFile::open() {
  std::error_code failed;
  const bool is_folder = fs::is_directory(target_, failed);
  if (is_folder || failed == std::errc::filename_too_long) {
    errno = is_folder ? EISDIR : ENAMETOOLONG;
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
      hand_on_permissions(stream_, temporary_, target_);
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
  for (std::size_t done = 0; done < count;) {
    const std::size_t now = write_some(stream_, behind_, size_ + done, bytes + done, std::min(count - done, kAtOnce));
    if (now == 0) fail("cannot write");
    done += now;
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
  size_ = std::max<std::uint64_t>(size_, fs::file_size(temporary_, unknown));
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
