#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace driftmesh {

/// Writes all bytes to an open file from a place on, counted from its beginning, and leaves the file's own position
/// alone: threads and processes may write to different places at the same time. Throws FileError, which says what
/// cannot be done to the file of that path ("cannot write") and the system's reason; some bytes may have been written
/// then.
void write_at(int file, std::uint64_t place, std::span<const std::byte> bytes, const std::string& path,
              const char* what = "cannot write");

}  // namespace driftmesh
