#include "base/unnamed_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <tuple>

#include "base/temporary_files.hpp"
#include "base/write_at.hpp"
#include "driftmesh/error.hpp"

namespace driftmesh {

struct UnnamedFile::Opened {
  int number;
};

/// Where the file system does not know files without names, one is created and unlinked at once.
int open_without_name(const std::string& folder) {
  // NOLINTBEGIN(cppcoreguidelines-pro-type-vararg)
  const int file = ::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
  if (file >= 0 || errno != EOPNOTSUPP) return file;
  const HeldSignals signals_wait;
  const std::string name = temporary_name(folder + "/scratch");
  const int named = ::open(name.c_str(), O_CREAT | O_EXCL | O_RDWR | O_CLOEXEC, 0600);
  // NOLINTEND(cppcoreguidelines-pro-type-vararg)
  if (named >= 0) ::unlink(name.c_str());
  return named;
}

UnnamedFile::UnnamedFile(const std::string& folder)
    : folder_(folder), opened_(std::make_unique<Opened>(Opened{open_without_name(folder)})) {
  if (opened_->number < 0) fail("cannot keep scratch data in this folder");
}

UnnamedFile::~UnnamedFile() {
  ::close(opened_->number);
}

void UnnamedFile::write(std::uint64_t place, std::span<const std::byte> bytes) {
  write_at(opened_->number, place, bytes, folder_, "cannot write scratch data to");
}

void UnnamedFile::read(std::uint64_t place, std::span<std::byte> to) const {
  while (!to.empty()) {
    errno = 0;
    const ssize_t got = ::pread(opened_->number, to.data(), to.size(), static_cast<off_t>(place));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) fail("cannot read scratch data from");
    to = to.subspan(static_cast<std::size_t>(got));
    place += static_cast<std::uint64_t>(got);
  }
}

void UnnamedFile::give_back(std::uint64_t place, std::uint64_t bytes) noexcept {
  std::ignore = ::fallocate(opened_->number, FALLOC_FL_PUNCH_HOLE | FALLOC_FL_KEEP_SIZE, static_cast<off_t>(place),
                            static_cast<off_t>(bytes));
}

void UnnamedFile::fail(const char* what) const {
  throw FileError(folder_, what);
}

}  // namespace driftmesh
