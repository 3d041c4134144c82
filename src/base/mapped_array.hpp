#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>

namespace driftmesh {

/// Bytes for arrays that may be larger than memory, all 0 at first. In portable builds they are memory; otherwise large
/// ones are mapped from a file without a name in the folder for temporary files (TMPDIR, else /tmp): the system keeps
/// in memory what is in use, as far as there is room, and the rest on disk.
class MappedRoom {
 public:
  MappedRoom() = default;
  /// Throws FileError if the folder has no room.
  explicit MappedRoom(std::uint64_t bytes);
  MappedRoom(MappedRoom&& other) noexcept { swap(other); }
  MappedRoom& operator=(MappedRoom&& other) noexcept {
    swap(other);
    return *this;
  }
  ~MappedRoom();

  [[nodiscard]] void* begin() const { return begin_; }

 private:
  void swap(MappedRoom& other) noexcept {
    std::swap(begin_, other.begin_);
    std::swap(bytes_, other.bytes_);
  }

  void* begin_ = nullptr;
  std::uint64_t bytes_ = 0;
};

/// An array in such room.
template <class T>
class MappedArray {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  MappedArray() = default;
  /// All elements are 0.
  explicit MappedArray(std::uint64_t size) : room_(size * sizeof(T)), size_(size) {}
  [[nodiscard]] std::uint64_t size() const { return size_; }
  T& operator[](std::uint64_t i) { return static_cast<T*>(room_.begin())[i]; }
  const T& operator[](std::uint64_t i) const { return static_cast<const T*>(room_.begin())[i]; }

 private:
  MappedRoom room_;
  std::uint64_t size_ = 0;
};

}  // namespace driftmesh
