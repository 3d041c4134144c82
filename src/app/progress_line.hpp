#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace driftmesh::app {

/// "refining  31 %  2 s left  3,400,000 of about 10,900,000 triangles  5.31 million/s"
[[nodiscard]] std::string refining_words(std::int64_t triangles, double forecast, double seconds);

/// One line on stderr that says what is going on, rewritten in place and erased at the end. Prints nothing when it is
/// not enabled, and nothing for work that takes less than half a second.
class ProgressLine {
 public:
  explicit ProgressLine(bool enabled) : enabled_(enabled) {}
  ~ProgressLine() { erase(); }
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  /// Work of this name begins.
  void begin(const std::string& stage);
  /// How far refinement is; the first call starts its clock.
  void refining(std::int64_t triangles, double forecast);
  void erase();

  /// Whether stderr is a terminal that can rewrite a line.
  [[nodiscard]] static bool possible();

 private:
  using Clock = std::chrono::steady_clock;
  void show(const std::string& text, Clock::time_point now);

  bool enabled_;
  bool shown_ = false;
  bool refining_ = false;
  Clock::time_point start_ = Clock::now();
  Clock::time_point refining_since_, last_;
};

}  // namespace driftmesh::app
