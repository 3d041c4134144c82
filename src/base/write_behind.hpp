#pragma once

#include <cstddef>
#include <cstdint>

namespace driftmesh {

/// Has the disk begin with a large file while the rest of it is still being written. By itself the system waits until
/// a tenth of the memory has to be written: seconds in which the disk does nothing.
class WriteBehind {
 public:
  /// Notes that bytes were written to an open file. As soon as enough of them follow each other the disk begins with
  /// them. Only advice: it has no effect on what is read, nor on files that are no disk's, and does not fail.
  void wrote(int file, std::uint64_t place, std::size_t count) noexcept;

 private:
  std::uint64_t begin_ = 0, end_ = 0;  // range not handed over yet
};

}  // namespace driftmesh
