#include "base/temporary_files.hpp"

#include <unistd.h>

#include <array>
#include <atomic>
#include <csignal>
#include <cstring>

namespace driftmesh {
namespace {

// A signal may find the process anywhere, also in malloc: names wait in fixed memory, and the handler only unlinks.
constexpr int kNone = -1;
constexpr std::size_t kSlots = 32;
constexpr std::size_t kLongestPath = 4096;

enum State : int { kFree, kInWork, kNoted };

struct Slot {
  std::atomic<int> state{kFree};
  char path[kLongestPath];
};

std::array<Slot, kSlots> slots;
static_assert(std::atomic<int>::is_always_lock_free);

extern "C" void remove_and_die(int signal) {
  for (const Slot& slot : slots)
    if (slot.state.load() == kNoted) ::unlink(slot.path);
  ::raise(signal);  // by now the default action, when this handler returns
}

}  // namespace

NotedTemporary::NotedTemporary(const std::string& path) : slot_(kNone) {
  if (path.size() >= kLongestPath) return;
  for (std::size_t i = 0; i < kSlots; ++i) {
    int expected = kFree;
    if (!slots[i].state.compare_exchange_strong(expected, kInWork)) continue;
    std::memcpy(slots[i].path, path.c_str(), path.size() + 1);
    slots[i].state.store(kNoted);
    slot_ = static_cast<int>(i);
    return;
  }
}

NotedTemporary::~NotedTemporary() {
  if (slot_ != kNone) slots[static_cast<std::size_t>(slot_)].state.store(kFree);
}

void remove_temporaries_on_signals() {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGPIPE}) {
    struct sigaction action {};
    if (::sigaction(signal, nullptr, &action) != 0) continue;
    if (action.sa_handler == SIG_IGN && signal != SIGPIPE) continue;
    action = {};
    action.sa_handler = remove_and_die;
    action.sa_flags = static_cast<int>(SA_RESETHAND);
    ::sigaction(signal, &action, nullptr);
  }
}

}  // namespace driftmesh
