#include "base/file_bytes.hpp"

#ifndef DRIFTMESH_PORTABLE
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>
#endif

#include "base/mapping.hpp"
#include "base/read_file.hpp"
#include "base/standard_streams.hpp"

namespace driftmesh {

FileBytes::FileBytes(const std::string& path, std::string_view first) {
  if (!is_standard_stream(path) && map(path)) return;
  read_ = read_file(path, first);
  view_ = read_;
}

FileBytes::~FileBytes() {
  if (mapped_ != nullptr) unmap(mapped_, view_.size());
}

#ifdef DRIFTMESH_PORTABLE

bool FileBytes::map(const std::string&) {
  return false;
}

#else

bool FileBytes::map(const std::string& path) {
  const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);  // does not wait for a pipe
  if (file < 0) return false;
  struct stat status {};
  if (fstat(file, &status) == 0 && S_ISREG(status.st_mode) && status.st_size > 0) {
    const auto size = static_cast<std::size_t>(status.st_size);
    void* const mapped = mmap(nullptr, size, PROT_READ, MAP_PRIVATE, file, 0);
    if (mapped != MAP_FAILED) {
      madvise(mapped, size, MADV_WILLNEED);
      mapped_ = mapped;
      view_ = {static_cast<const char*>(mapped), size};
    }
  }
  close(file);
  return mapped_ != nullptr;
}

#endif

}  // namespace driftmesh
