#include "base/scratch_file.hpp"

#include <fcntl.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <cerrno>
#include <tuple>
#include <utility>

#include "base/temporary_files.hpp"
#include "base/write_at.hpp"
#include "driftmesh/error.hpp"

namespace driftmesh {

/// Where the file system does not know files without names, one is created and unlinked at once.
int open_without_name(const std::string& folder) {
  // NOLINTBEGIN(cppcoreguidelines-pro-type-vararg)
  const int file = ::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
  if (file >= 0 || errno != EOPNOTSUPP) return file;
  const HeldSignals held;
  const std::string name = temporary_name(folder + "/scratch");
  const int named = ::open(name.c_str(), O_CREAT | O_EXCL | O_RDWR | O_CLOEXEC, 0600);
  // NOLINTEND(cppcoreguidelines-pro-type-vararg)
  if (named >= 0) ::unlink(name.c_str());
  return named;
}

ScratchFile::ScratchFile(std::string folder) : folder_(std::move(folder)), file_(open_without_name(folder_)) {
  if (file_ < 0) fail("cannot keep scratch data in this folder");
}

ScratchFile::~ScratchFile() {
  discard();
}

void ScratchFile::discard() {
  if (file_ >= 0) ::close(file_);
  file_ = -1;
}

ScratchFile::Piece ScratchFile::put(std::initializer_list<std::span<const std::byte>> parts) {
  std::uint64_t bytes = 0;
  for (const auto part : parts) bytes += part.size();
  Piece piece(*this, end_.fetch_add(bytes), bytes);
  std::uint64_t place = piece.begin_;
  for (const auto part : parts) {
    write_at(file_, place, part, folder_, "cannot write scratch data to");
    place += part.size();
  }
  return piece;
}

std::uint64_t ScratchFile::room() const {
  struct statvfs found {};
  if (::fstatvfs(file_, &found) != 0) fail("cannot tell the free space of");
  return static_cast<std::uint64_t>(found.f_bavail) * found.f_frsize;
}

void ScratchFile::fail(const char* what) const {
  throw FileError(folder_, what);
}

ScratchFile::Piece::Piece(Piece&& other) noexcept
    : file_(std::exchange(other.file_, nullptr)), begin_(other.begin_), bytes_(other.bytes_) {}

ScratchFile::Piece& ScratchFile::Piece::operator=(Piece&& other) noexcept {
  std::swap(file_, other.file_);
  std::swap(begin_, other.begin_);
  std::swap(bytes_, other.bytes_);
  return *this;
}

ScratchFile::Piece::~Piece() {
  if (file_ == nullptr || file_->file_ < 0 || bytes_ == 0) return;
  std::ignore = ::fallocate(file_->file_, FALLOC_FL_PUNCH_HOLE | FALLOC_FL_KEEP_SIZE, static_cast<off_t>(begin_),
                            static_cast<off_t>(bytes_));
}

void ScratchFile::Piece::read(std::uint64_t offset, std::span<std::byte> to) const {
  while (!to.empty()) {
    errno = 0;
    const ssize_t got = ::pread(file_->file_, to.data(), to.size(), static_cast<off_t>(begin_ + offset));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) file_->fail("cannot read scratch data from");
    to = to.subspan(static_cast<std::size_t>(got));
    offset += static_cast<std::uint64_t>(got);
  }
}

}  // namespace driftmesh
