#include "base/temporary_files.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cctype>
#include <cerrno>
#include <charconv>
#include <climits>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <mutex>
#include <set>
#include <string_view>
#include <vector>

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

constexpr int kSignals[] = {SIGINT, SIGTERM, SIGHUP, SIGPIPE};

extern "C" void remove_and_die(int signal) {
  if (held.load() > 0) {
    waiting.store(signal);
    if (held.load() > 0) return;  // otherwise nobody may look anymore whether a signal waits
  }
  remove_noted_temporaries();
  struct sigaction action {};
  action.sa_handler = SIG_DFL;
  ::sigaction(signal, &action, nullptr);
  ::raise(signal);  // takes effect when this handler returns
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

// ---- Whose a temporary file is ---------------------------------------------------------------------------------

constexpr std::string_view kMark = ".tmp-";

/// Process numbers mean something within one host and one namespace of processes: containers may share folders and even
/// the name of their host, but not the namespace.
std::string host() {
  char name[65] = "host";
  static_cast<void>(::gethostname(name, sizeof name - 1));
  std::string text = name;
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return std::isalnum(c) == 0 && c != '.' && c != '_'; }, '_');
  struct stat processes {};
  if (::stat("/proc/self/ns/pid", &processes) == 0) text.append(1, '.').append(std::to_string(processes.st_ino));
  return text;
}

std::string mark_of_host() {
  static const std::string mark = std::string(kMark) + host() + "-";
  return mark;
}

/// The process that a temporary file of this host belongs to; 0 for any other file.
pid_t owner_of(std::string_view name) {
  const std::string mark = mark_of_host();
  const std::size_t at = name.rfind(mark);
  if (at == std::string_view::npos || at == 0) return 0;
  const char *begin = name.data() + at + mark.size(), *const end = name.data() + name.size();
  pid_t process = 0;
  unsigned number = 0;
  const auto [dash, no_process] = std::from_chars(begin, end, process);
  if (no_process != std::errc() || dash == end || *dash != '-') return 0;
  const auto [last, no_number] = std::from_chars(dash + 1, end, number);
  return no_number == std::errc() && last == end ? process : 0;
}

bool is_dead(pid_t process) {
  return process > 0 && ::kill(process, 0) == -1 && errno == ESRCH;
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
  const std::string ending = mark_of_host() + std::to_string(::getpid()) + "-" + std::to_string(counter++);
  const fs::path path(target);
  std::string name = path.filename().string();
  if (name.size() + ending.size() > NAME_MAX)
    name.resize(NAME_MAX - std::min<std::size_t>(ending.size(), NAME_MAX - 1));
  return (path.parent_path() / (name + ending)).string();
}

void remove_remains_beside(const std::string& target) {
  const fs::path folder = folder_of(target);
  std::error_code ignored;
  if (!is_first_look(fs::absolute(folder, ignored).string())) return;
  std::vector<fs::path> remains;
  for (fs::directory_iterator at(folder, ignored), end; !ignored && at != end; at.increment(ignored))
    if (at->symlink_status(ignored).type() == fs::file_type::regular &&
        is_dead(owner_of(at->path().filename().string())))
      remains.push_back(at->path());
  for (const fs::path& file : remains) fs::remove(file, ignored);
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
    if (note->state.load() == Note::kNoted) ::unlink(note->path);
}

void remove_temporaries_on_signals() {
  for (const int signal : kSignals) {
    struct sigaction action {};
    if (::sigaction(signal, nullptr, &action) != 0) continue;
    if (action.sa_handler == SIG_IGN && signal != SIGPIPE) continue;
    action = {};
    action.sa_handler = remove_and_die;
    action.sa_flags = SA_RESTART;
    ::sigaction(signal, &action, nullptr);
  }
}

HeldSignals::HeldSignals() {
  ++held;
}

HeldSignals::~HeldSignals() {
  if (--held > 0) return;
  if (const int signal = waiting.exchange(0); signal != 0) ::raise(signal);
}

}  // namespace driftmesh
