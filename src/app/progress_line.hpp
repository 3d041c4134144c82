#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <string>
#include <thread>

namespace driftmesh::app {

/// "writing bay.vtu  4 s  1.2 GB  310 MB/s"
[[nodiscard]] std::string writing_words(const std::string& path, double seconds, std::uint64_t bytes);

/// "refining  31 %  2 s left  3,400,000 of about 10,900,000 triangles  5.31 M/s"
[[nodiscard]] std::string refining_words(std::int64_t triangles, double forecast, double seconds);

/// Shows progress on stderr from its own thread, so that stages that report nothing are shown too. A terminal shows one
/// line, rewritten in place after half a second of silence. Anything else, such as the pipe that mpirun makes of
/// stderr, gets a line after 5, 10, 20, 40 and 80 seconds of a stage and then every minute. Does nothing unless
/// enabled.
class ProgressLine {
 public:
  explicit ProgressLine(bool enabled);
  ~ProgressLine() { end(); }
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  /// A stage of this name begins.
  void begin(const std::string& stage);
  /// Progress of refinement; the first call starts its clock.
  void refining(std::int64_t triangles, double forecast);
  /// A file is about to be written.
  void writing(const std::string& path);
  /// Writes `text`, whole lines, to stderr without mixing the two.
  void write(const std::string& text);
  /// Erases the line for good.
  void end();

 private:
  using Clock = std::chrono::steady_clock;
  void run(const std::stop_token& stop);
  [[nodiscard]] Clock::duration next_wait() const;
  [[nodiscard]] std::string text() const;
  void rewrite_line();
  void erase();

  std::mutex mutex_;  // guards the members below, and stderr while the thread runs
  std::condition_variable_any wake_;
  const bool rewrites_;
  std::string stage_;
  std::string file_;                        // empty: none is written
  Clock::time_point since_ = Clock::now();  // the stage, or what it does now
  Clock::time_point stage_since_ = since_;
  Clock::time_point due_;  // the next line
  std::uint64_t written_before_ = 0;
  bool refining_ = false;
  std::int64_t triangles_ = 0;
  double forecast_ = 0;
  bool shown_ = false;
  std::jthread thread_;
};

}  // namespace driftmesh::app
