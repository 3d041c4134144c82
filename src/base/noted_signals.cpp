#include "base/noted_signals.hpp"

#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdlib>

#include "base/temporary_files.hpp"

namespace driftmesh {
namespace {

std::atomic<bool> end_noted{false}, request_noted{false};
static_assert(std::atomic<bool>::is_always_lock_free);

struct sigaction before_end {
}, before_request{}, before_alarm{};

constexpr unsigned kPatience = 20;  // seconds

// Only what a handler may call.
extern "C" void note_signal(int signal) {
  (signal == SIGTERM ? end_noted : request_noted).store(true);
  if (signal == SIGTERM) ::alarm(kPatience);
}

extern "C" void give_up(int /*signal*/) {
  constexpr char kWhy[] = "driftmesh: told to end, but another process does not answer; the last checkpoint stays\n";
  remove_noted_temporaries();
  static_cast<void>(!::write(STDERR_FILENO, kWhy, sizeof kWhy - 1));
  ::_exit(EXIT_FAILURE);
}

void handle(int signal, void (*handler)(int), struct sigaction& before) {
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = SA_RESTART;
  ::sigaction(signal, &action, &before);
}

}  // namespace

NotedSignals::NotedSignals() {
  end_noted.store(false);
  request_noted.store(false);
  handle(SIGALRM, give_up, before_alarm);
  handle(SIGTERM, note_signal, before_end);
  handle(SIGUSR1, note_signal, before_request);
}

NotedSignals::~NotedSignals() {
  ::sigaction(SIGTERM, &before_end, nullptr);
  ::sigaction(SIGUSR1, &before_request, nullptr);
  have_met();
  ::sigaction(SIGALRM, &before_alarm, nullptr);
}

void NotedSignals::have_met() {
  ::alarm(0);
}

bool NotedSignals::told_to_end() {
  return end_noted.load();
}

bool NotedSignals::requested() {
  return request_noted.load();
}

void NotedSignals::forget_request() {
  request_noted.store(false);
}

}  // namespace driftmesh
