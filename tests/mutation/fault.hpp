#pragma once

// The switch of mutation.py: sources that it copies ask here whether they are to be faulty. Each program reads from its
// environment which fault is on (DRIFTMESH_FAULT, a number) and where to note which places it has passed
// (DRIFTMESH_FAULTS_PASSED, a file that all processes of a test share).

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstdlib>
#include <type_traits>

// What stands on both sides of a choice may look odd in its company.
#pragma GCC diagnostic ignored "-Wextra"
#pragma GCC diagnostic ignored "-Wsign-compare"
#pragma GCC diagnostic ignored "-Wparentheses"
#pragma GCC diagnostic ignored "-Wunused-value"
#pragma GCC diagnostic ignored "-Wunused-result"
#pragma GCC diagnostic ignored "-Wunused-variable"
#pragma GCC diagnostic ignored "-Wunused-but-set-variable"
#pragma GCC diagnostic ignored "-Wmisleading-indentation"
#pragma GCC diagnostic ignored "-Wdangling-else"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wreturn-type"

namespace driftmesh_mutation {

inline constexpr unsigned kPlaces = 1U << 16;

inline unsigned number_from_environment() {
  const char* const text = std::getenv("DRIFTMESH_FAULT");
  return text == nullptr ? 0 : static_cast<unsigned>(std::strtoul(text, nullptr, 10));
}

inline volatile unsigned char* noted_places() {
  static unsigned char nobody_reads[kPlaces];
  const char* const name = std::getenv("DRIFTMESH_FAULTS_PASSED");
  if (name == nullptr) return nobody_reads;
  const int file = ::open(name, O_RDWR);
  if (file < 0) return nobody_reads;
  void* const shared = ::mmap(nullptr, kPlaces, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
  ::close(file);
  return shared == MAP_FAILED ? nobody_reads : static_cast<unsigned char*>(shared);
}

inline bool is_on(unsigned fault) {
  static const unsigned chosen = number_from_environment();
  static volatile unsigned char* const passed = noted_places();
  passed[fault % kPlaces] = 1;
  return fault == chosen;
}

}  // namespace driftmesh_mutation

constexpr bool driftmesh_fault(unsigned fault) {
  return std::is_constant_evaluated() ? false : driftmesh_mutation::is_on(fault);
}
