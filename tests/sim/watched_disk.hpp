#pragma once

#include <cstddef>
#include <string>

namespace driftmesh::sim {

/// What becomes of what a thread writes. Only programs that link watched_disk.cpp ask: their writes to places of files
/// and renames go through it.
class DiskWatch {
 public:
  virtual ~DiskWatch() = default;
  DiskWatch(const DiskWatch&) = delete;
  DiskWatch& operator=(const DiskWatch&) = delete;

  /// So many bytes are about to be written: how many are, or -1 for "no space left on device". `by_hdf5`: by that
  /// library.
  [[nodiscard]] virtual std::ptrdiff_t about_to_write(std::size_t bytes, bool by_hdf5) = 0;
  /// They have been. Whether nobody looks at the disk anymore, so that the writer, whom HDF5 trusts, may write all.
  [[nodiscard]] virtual bool is_over() = 0;
  virtual void about_to_rename(const std::string& from, const std::string& to) = 0;
  virtual void has_renamed(const std::string& to) = 0;

 protected:
  DiskWatch() = default;
};

/// That of this thread, for as long as the object exists.
class WatchedDisk {
 public:
  explicit WatchedDisk(DiskWatch& watch);
  ~WatchedDisk();
  WatchedDisk(const WatchedDisk&) = delete;
  WatchedDisk& operator=(const WatchedDisk&) = delete;
};

}  // namespace driftmesh::sim
