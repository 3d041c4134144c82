#pragma once

namespace driftmesh {

/// While one exists, SIGTERM and SIGUSR1 do nothing but leave a note: for who wants to end in an orderly way, or is
/// asked for something meanwhile. One at a time.
class NotedSignals {
 public:
  NotedSignals();
  ~NotedSignals();
  NotedSignals(const NotedSignals&) = delete;
  NotedSignals& operator=(const NotedSignals&) = delete;

  /// SIGTERM has come.
  [[nodiscard]] static bool told_to_end();
  /// SIGUSR1 has come since the last forget_request().
  [[nodiscard]] static bool requested();
  static void forget_request();

  /// All processes of a run that were told to end must meet soon after: one that waits longer for the others, because
  /// one of them is dead, ends with a message. Called when they have met.
  static void have_met();
};

}  // namespace driftmesh
