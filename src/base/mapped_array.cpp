#include "base/mapped_array.hpp"

#ifndef DRIFTMESH_PORTABLE
#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>
#endif

#include <cstdlib>
#include <string>

#include "base/mapping.hpp"
#include "base/unnamed_file.hpp"
#include "driftmesh/error.hpp"

namespace driftmesh {
namespace {

#ifdef DRIFTMESH_PORTABLE

void* room_for(std::uint64_t bytes) {
  return std::calloc(bytes, 1);
}

void give_back(void* begin, std::uint64_t) {
  std::free(begin);
}

#else

constexpr std::uint64_t kSmall = std::uint64_t{256} << 20;  // bytes; below, memory it is

std::string folder_for_temporary_files() {
  const char* const named = std::getenv("TMPDIR");  // NOLINT(concurrency-mt-unsafe): nobody changes it
  return named != nullptr && *named != '\0' ? named : "/tmp";
}

/// nullptr if there is none.
void* room_for(std::uint64_t bytes) {
  if (bytes <= kSmall) return extend_mapping(nullptr, 0, bytes);
  const std::string folder = folder_for_temporary_files();
  const int file = open_without_name(folder);
  if (file < 0) throw FileError(folder, "cannot keep scratch data in this folder");
  // Without its room on disk, writing to the mapping could end the process.
  const bool has_room = posix_fallocate(file, 0, static_cast<off_t>(bytes)) == 0;
  void* const mapped = has_room ? mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0) : MAP_FAILED;
  close(file);
  if (!has_room)
    throw FileError(folder + ": has no room for " + std::to_string(bytes >> 20) +
                    " MB of scratch data; set TMPDIR to a folder on a larger disk");
  return mapped == MAP_FAILED ? nullptr : mapped;
}

void give_back(void* begin, std::uint64_t bytes) {
  unmap(begin, bytes);
}

#endif

}  // namespace

MappedRoom::MappedRoom(std::uint64_t bytes) : bytes_(bytes) {
  if (bytes == 0) return;
  begin_ = room_for(bytes);
  if (begin_ == nullptr) throw LimitError("no room for an array of " + std::to_string(bytes >> 20) + " MB");
}

MappedRoom::~MappedRoom() {
  if (begin_ != nullptr) give_back(begin_, bytes_);
}

}  // namespace driftmesh
