#include "mutants/memory_limit.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <atomic>
#include <cstddef>
#include <fstream>

#ifdef __SANITIZE_ADDRESS__
// Declared in <sanitizer/allocator_interface.h>, which GCC 12 does not come with.
extern "C" {
int __sanitizer_install_malloc_and_free_hooks(void (*on_malloc)(const volatile void*, std::size_t),
                                              void (*on_free)(const volatile void*));
std::size_t __sanitizer_get_allocated_size(const volatile void* place);
}
#endif

namespace driftmesh::mutants {

#ifdef __SANITIZE_ADDRESS__
// The address space is the sanitizer's, so the heap is counted instead: what is asked for and not given back. Hooks may
// not allocate.
namespace {

std::atomic<std::size_t> held{0}, most_held{0}, measured_from{0}, limit{~std::size_t{0}};

void note_allocation(const volatile void* /*place*/, std::size_t size) {
  const std::size_t now = held += size;
  if (now > most_held) most_held = now;
  if (now > limit) ::_exit(kMemoryExit);
}

void note_release(const volatile void* place) {
  if (place != nullptr) held -= __sanitizer_get_allocated_size(place);
}

}  // namespace

void limit_memory(std::size_t bytes) {
  // What was allocated before is not known to the hooks, but may be given back: counting begins in the middle.
  held = std::size_t{1} << 60;
  limit = held + bytes;
  __sanitizer_install_malloc_and_free_hooks(note_allocation, note_release);
}

void start_measuring() {
  measured_from = held.load();
  most_held = held.load();
}
std::size_t most_measured() {
  return most_held - measured_from;
}
#else
void limit_memory(std::size_t bytes) {
  std::size_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  const rlim_t most = pages * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE)) + bytes;
  const rlimit wanted{most, most};
  (void)::setrlimit(RLIMIT_AS, &wanted);
}

void start_measuring() {}
std::size_t most_measured() {
  return 0;
}
#endif

}  // namespace driftmesh::mutants
