#include "base/write_behind.hpp"

#ifndef DRIFTMESH_PORTABLE
#include <fcntl.h>
#endif

#include <atomic>
#include <tuple>

#include "base/bytes_written.hpp"

namespace driftmesh {
namespace {

constexpr std::uint64_t kEnough = std::uint64_t{16} << 20;  // for a disk to take about as long as for a long seek

std::atomic<std::uint64_t> all_bytes{0};

}  // namespace

std::uint64_t bytes_written() noexcept {
  return all_bytes.load(std::memory_order_relaxed);
}

void WriteBehind::wrote(int file, std::uint64_t place, std::size_t count) noexcept {
  all_bytes.fetch_add(count, std::memory_order_relaxed);
  if (place != end_) begin_ = place;
  end_ = place + count;
  if (end_ - begin_ < kEnough) return;
#ifdef DRIFTMESH_PORTABLE
  std::ignore = file;
#else
  std::ignore = ::sync_file_range(file, static_cast<off_t>(begin_), static_cast<off_t>(end_ - begin_),
                                  SYNC_FILE_RANGE_WRITE);  // begins, and does not wait
#endif
  begin_ = end_;
}

}  // namespace driftmesh
