#include <csignal>
#include <random>

#include "base/system.hpp"

namespace driftmesh {

std::string host_of_processes() {
  return "portable";
}

long number_of_process() {
  static const long number = static_cast<long>(std::random_device()() >> 1 & 0x7FFFFFFF);
  return number;
}

bool has_ended(long) {
  return false;
}

std::uint64_t memory_of_machine() {
  return std::uint64_t{16} << 30;
}

void call_at_ending_signals(void (*handler)(int)) {
  for (const int signal : {SIGINT, SIGTERM})
    if (std::signal(signal, handler) == SIG_IGN) std::signal(signal, SIG_IGN);
}

void end_by(int signal) {
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

}  // namespace driftmesh
