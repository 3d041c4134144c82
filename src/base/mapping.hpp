#pragma once

#include <cstddef>
#ifndef DRIFTMESH_PORTABLE
#include <sys/mman.h>
#endif

namespace driftmesh {

#ifdef DRIFTMESH_PORTABLE

inline constexpr bool kHasMappings = false;
inline void* extend_mapping(void*, std::size_t, std::size_t) noexcept {
  return nullptr;
}
inline void unmap(void*, std::size_t) noexcept {}
inline void request_huge_pages(void*, std::size_t) noexcept {}

#else

/// Whether the system gives out memory in mappings, which it extends without copying.
inline constexpr bool kHasMappings = true;

/// The mapping of `old` bytes with `bytes` instead, perhaps elsewhere; 0 old ones: a new mapping. nullptr if there is
/// no more memory to map.
inline void* extend_mapping(void* begin, std::size_t old, std::size_t bytes) noexcept {
  void* const extended =
      old != 0 ? mremap(begin, old, bytes, MREMAP_MAYMOVE)
               : mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  return extended == MAP_FAILED ? nullptr : extended;
}

inline void unmap(void* begin, std::size_t bytes) noexcept {
  munmap(begin, bytes);
}

/// Only advice, for whole pages.
inline void request_huge_pages(void* begin, std::size_t bytes) noexcept {
  madvise(begin, bytes, MADV_HUGEPAGE);
}

#endif

}  // namespace driftmesh
