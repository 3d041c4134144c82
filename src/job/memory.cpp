#include "job/memory.hpp"

#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>

namespace driftmesh::job {
namespace {

std::optional<std::uint64_t> number_in(const std::string& file) {
  std::uint64_t number = 0;
  if (std::ifstream(file) >> number) return number;
  return std::nullopt;  // no such file, or "max"
}

std::uint64_t free_on_machine() {
  std::ifstream info("/proc/meminfo");
  for (std::string line; std::getline(info, line);)
    if (line.starts_with("MemAvailable:")) return std::stoull(line.substr(13)) * 1024;
  return 0;
}

/// Memory of this process in pages, as proc(5) describes it.
struct Pages {
  std::uint64_t total = 0, resident = 0, shared = 0, text = 0, libraries = 0, data = 0;
};

/// The file stays open, because limits on memory are checked often.
Pages pages_of_process() {
  static const int file = open("/proc/self/statm", O_RDONLY | O_CLOEXEC);  // NOLINT(cppcoreguidelines-pro-type-vararg)
  std::array<char, 256> text{};
  Pages pages;
  if (file < 0 || pread(file, text.data(), text.size() - 1, 0) <= 0) return pages;
  std::istringstream(text.data()) >> pages.total >> pages.resident >> pages.shared >> pages.text >> pages.libraries >>
      pages.data;
  return pages;
}

std::uint64_t page() {
  return static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

}  // namespace

std::uint64_t peak_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

std::uint64_t present_memory() {
  return pages_of_process().resident * page();
}

std::uint64_t free_memory() {
  const std::uint64_t machine = free_on_machine();
  const auto limit = number_in("/sys/fs/cgroup/memory.max"), used = number_in("/sys/fs/cgroup/memory.current");
  if (!limit || !used) return machine;
  const std::uint64_t group = *limit > *used ? *limit - *used : 0;
  return machine == 0 ? group : std::min(machine, group);
}

void cap_memory(std::uint64_t bytes) {
  rlimit limit{};
  if (getrlimit(RLIMIT_DATA, &limit) != 0) return;
  limit.rlim_cur = limit.rlim_max;
  const Pages now = pages_of_process();
  const std::uint64_t room = bytes > now.resident * page() ? bytes - now.resident * page() : 0;
  if (bytes != 0 && now.data != 0) limit.rlim_cur = std::min<rlim_t>(limit.rlim_max, now.data * page() + room);
  setrlimit(RLIMIT_DATA, &limit);
}

std::uint64_t room_under_cap() {
  rlimit limit{};
  if (getrlimit(RLIMIT_DATA, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return UINT64_MAX;
  const std::uint64_t mapped = pages_of_process().data * page();
  return limit.rlim_cur > mapped ? limit.rlim_cur - mapped : 0;
}

}  // namespace driftmesh::job
