#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <new>
#include <type_traits>
#include <utility>

#include "base/mapping.hpp"
#include "driftmesh/id_vector.hpp"

namespace driftmesh {

/// A contiguous array of trivially copyable values that grows without copying once it is large: small arrays live on
/// the heap, large ones in their own mapping, which the system extends in place or by moving page tables, if it can.
/// Since that costs little, large arrays grow in small steps: what a process has mapped stays close to what it uses,
/// and can be limited (see cap_memory in job/memory.hpp). Large mappings request huge pages, because accesses to a mesh
/// are too scattered for a TLB of small pages. Elements above size() are uninitialized. Throws std::bad_alloc when the
/// system has no more memory to map. Elements are indexed by Id.
template <class T, IsId Id = std::size_t>
class GrowingArray {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  GrowingArray() = default;
  GrowingArray(GrowingArray&& other) noexcept { swap(other); }
  GrowingArray& operator=(GrowingArray&& other) noexcept {
    swap(other);
    return *this;
  }
  GrowingArray(const GrowingArray& other) { assign(other.data_, other.size_); }
  GrowingArray& operator=(const GrowingArray& other) {
    if (this != &other) assign(other.data_, other.size_);
    return *this;
  }
  ~GrowingArray() { release(); }

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] bool empty() const { return size_ == 0; }
  [[nodiscard]] std::size_t capacity() const { return capacity_; }
  [[nodiscard]] T* data() { return data_; }
  [[nodiscard]] const T* data() const { return data_; }
  [[nodiscard]] const T& back() const { return data_[size_ - 1]; }
  [[nodiscard]] T& operator[](Id id) { return data_[to_index(id)]; }
  [[nodiscard]] const T& operator[](Id id) const { return data_[to_index(id)]; }
  /// Whether an element has this number.
  [[nodiscard]] bool has(Id id) const { return to_index(id) < size_; }
  /// The number that the next element will get.
  [[nodiscard]] Id next_id() const { return static_cast<Id>(size_); }
  [[nodiscard]] T* begin() { return data_; }
  [[nodiscard]] T* end() { return data_ + size_; }
  [[nodiscard]] const T* begin() const { return data_; }
  [[nodiscard]] const T* end() const { return data_ + size_; }

  void push_back(const T& value) {
    if (size_ == capacity_) {
      const T copy = value;  // it may live in the array that is about to move
      grow(size_ + 1);
      data_[size_++] = copy;
    } else {
      data_[size_++] = value;
    }
  }

  void pop_back() { --size_; }

  /// Sets the size; new elements are uninitialized.
  void resize_uninitialized(std::size_t size) {
    if (size > capacity_) grow(size);
    size_ = size;
  }
  void resize(std::size_t size, const T& value) {
    const std::size_t old = size_;
    resize_uninitialized(size);
    for (std::size_t i = old; i < size; ++i) data_[i] = value;
  }
  void reserve(std::size_t capacity) {
    if (capacity > capacity_) reallocate(capacity);
  }
  void clear() { size_ = 0; }

  void swap(GrowingArray& other) noexcept {
    std::swap(data_, other.data_);
    std::swap(size_, other.size_);
    std::swap(capacity_, other.capacity_);
    std::swap(mapped_bytes_, other.mapped_bytes_);
  }

 private:
  static constexpr std::size_t kMapFrom = std::size_t{4} << 20;  // bytes; below, the heap wastes less
  static constexpr std::size_t kHugePage = std::size_t{2} << 20;

  void assign(const T* data, std::size_t size) {
    resize_uninitialized(size);
    if (size != 0) std::memcpy(data_, data, size * sizeof(T));
  }
  void grow(std::size_t needed) {
    const std::size_t step = mapped_bytes_ != 0 ? capacity_ / 32 : capacity_;
    reallocate(std::max({needed, capacity_ + step, std::size_t{16}}));
  }

  void reallocate(std::size_t capacity) {
    const std::size_t bytes = capacity * sizeof(T);
    if (kHasMappings && bytes >= kMapFrom) {
      reallocate_mapped((bytes + kHugePage - 1) / kHugePage * kHugePage);
      capacity_ = mapped_bytes_ / sizeof(T);
      return;
    }
    void* grown = std::realloc(static_cast<void*>(data_), bytes);
    if (grown == nullptr) throw std::bad_alloc();
    data_ = static_cast<T*>(grown);
    capacity_ = capacity;
  }

  void reallocate_mapped(std::size_t bytes) {
    void* grown = extend_mapping(data_, mapped_bytes_, bytes);
    if (grown == nullptr) throw std::bad_alloc();
    request_huge_pages(grown, bytes);
    if (mapped_bytes_ == 0 && data_ != nullptr) {
      std::memcpy(grown, static_cast<const void*>(data_), size_ * sizeof(T));
      std::free(static_cast<void*>(data_));
    }
    data_ = static_cast<T*>(grown);
    mapped_bytes_ = bytes;
  }

  void release() {
    if (mapped_bytes_ != 0)
      unmap(data_, mapped_bytes_);
    else
      std::free(static_cast<void*>(data_));
  }

  T* data_ = nullptr;
  std::size_t size_ = 0;
  std::size_t capacity_ = 0;
  std::size_t mapped_bytes_ = 0;  // 0: on the heap
};

template <class T, IsId Id>
[[nodiscard]] IdRange<Id> ids_of(const GrowingArray<T, Id>& values) {
  return IdRange<Id>(values.size());
}

}  // namespace driftmesh
