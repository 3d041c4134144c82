#include "sim/watched_disk.hpp"

#include <dlfcn.h>
#include <fcntl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

namespace driftmesh::sim {
namespace {

thread_local DiskWatch* watch = nullptr;

ssize_t write_to_disk(int file, const void* bytes, std::size_t count, off_t place) {
  return ::syscall(SYS_pwrite64, file, bytes, count, place);
}

bool is_of_hdf5(const void* caller) {
  Dl_info library{};
  return ::dladdr(caller, &library) != 0 && std::strstr(library.dli_fname, "hdf5") != nullptr;
}

ssize_t watched_write(int file, const void* bytes, std::size_t count, off_t place, const void* caller) {
  if (watch == nullptr) return write_to_disk(file, bytes, count, place);
  const std::ptrdiff_t some = watch->about_to_write(count, is_of_hdf5(caller));
  if (some < 0) {
    errno = ENOSPC;
    return -1;
  }
  const ssize_t written = write_to_disk(file, bytes, static_cast<std::size_t>(some), place);
  if (written >= 0 && watch->is_over()) return write_to_disk(file, bytes, count, place);
  return written;
}

}  // namespace

WatchedDisk::WatchedDisk(DiskWatch& of_thread) {
  watch = &of_thread;
}

WatchedDisk::~WatchedDisk() {
  watch = nullptr;
}

}  // namespace driftmesh::sim

// In place of those of the C library, for this program and all that it loads.
extern "C" {

ssize_t pwrite(int file, const void* bytes, std::size_t count, off_t place) {
  return driftmesh::sim::watched_write(file, bytes, count, place, __builtin_return_address(0));
}

ssize_t pwrite64(int file, const void* bytes, std::size_t count, off64_t place) {
  return driftmesh::sim::watched_write(file, bytes, count, place, __builtin_return_address(0));
}

int rename(const char* from, const char* to) noexcept {
  using driftmesh::sim::watch;
  if (watch != nullptr) watch->about_to_rename(from, to);
  const int failed = ::renameat(AT_FDCWD, from, AT_FDCWD, to);
  if (failed == 0 && watch != nullptr) watch->has_renamed(to);
  return failed;
}
}
