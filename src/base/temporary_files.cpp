#include "base/temporary_files.hpp"

#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <mutex>
#include <set>
#include <string_view>

#include "base/remains.hpp"
#include "base/system.hpp"

namespace driftmesh {

// A signal may find the process anywhere, also in malloc: names wait in memory that is never freed, and the handler
// only unlinks. Notes are used again.
struct Note {
  enum State : int { kFree, kInWork, kNoted };
  std::atomic<int> state{kInWork};
  char path[4096];
  Note* next = nullptr;
};

namespace {

namespace fs = std::filesystem;

std::atomic<Note*> notes{nullptr};
std::atomic<int> held{0};     // how many HeldSignals there are
std::atomic<int> waiting{0};  // a signal that came meanwhile, or 0
static_assert(std::atomic<int>::is_always_lock_free && std::atomic<Note*>::is_always_lock_free);

extern "C" void remove_and_die(int signal) {
  if (held.load() > 0) {
    waiting.store(signal);
    if (held.load() > 0) return;  // otherwise nobody may look anymore whether a signal waits
  }
  remove_noted_temporaries();
  end_by(signal);
}

Note* free_note() {
  for (Note* note = notes.load(); note != nullptr; note = note->next) {
    int expected = Note::kFree;
    if (note->state.compare_exchange_strong(expected, Note::kInWork)) return note;
  }
  Note* const made = new Note;  // lives as long as the process
  made->next = notes.load();
  while (!notes.compare_exchange_weak(made->next, made)) {
  }
  return made;
}

constexpr std::size_t kLongestName = 255;

std::string mark_of_host() {
  static const std::string mark = std::string(kTemporaryMark) + host_of_processes() + "-";
  return mark;
}

fs::path folder_of(const std::string& target) {
  const fs::path folder = fs::path(target).parent_path();
  return folder.empty() ? "." : folder;
}

bool is_first_look(const std::string& folder) {
  static std::mutex alone;
  static std::set<std::string> seen;
  const std::lock_guard lock(alone);
  return seen.insert(folder).second;
}

}  // namespace

std::string temporary_name(const std::string& target) {
  static std::atomic<unsigned> counter{0};
  const std::string ending = mark_of_host() + std::to_string(number_of_process()) + "-" + std::to_string(counter++);
  const fs::path path(target);
  std::string name = path.filename().string();
  if (name.size() + ending.size() > kLongestName) name.resize(kLongestName - std::min(ending.size(), kLongestName - 1));
  return (path.parent_path() / (name + ending)).string();
}

void remove_remains_beside(const std::string& target) {
  const fs::path folder = folder_of(target);
  std::error_code ignored;
  if (!is_first_look(fs::absolute(folder, ignored).string())) return;
  for (const Remains& file : temporaries_in(folder.string()))
    if (is_abandoned(file)) fs::remove(file.path, ignored);
}

NotedTemporary::NotedTemporary(const std::string& path) : note_(nullptr) {
  if (path.size() >= sizeof(Note::path)) return;
  note_ = free_note();
  std::memcpy(note_->path, path.c_str(), path.size() + 1);
  note_->state.store(Note::kNoted);
}

NotedTemporary::~NotedTemporary() {
  if (note_ != nullptr) note_->state.store(Note::kFree);
}

void remove_noted_temporaries() noexcept {
  for (const Note* note = notes.load(); note != nullptr; note = note->next)
    if (note->state.load() == Note::kNoted) std::remove(note->path);  // which calls unlink() and no more
}

void remove_temporaries_on_signals() {
  call_at_ending_signals(remove_and_die);
}

HeldSignals::HeldSignals() {
  ++held;
}

HeldSignals::~HeldSignals() {
  if (--held > 0) return;
  if (const int signal = waiting.exchange(0); signal != 0) std::raise(signal);
}

}  // namespace driftmesh
