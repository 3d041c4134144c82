#include "app/progress_line.hpp"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "app/words.hpp"

namespace driftmesh::app {
namespace {

constexpr auto kFirstAfter = std::chrono::milliseconds(500);
constexpr auto kEvery = std::chrono::milliseconds(100);

std::size_t terminal_width() {
  winsize size{};
  return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

}  // namespace

// What matters most comes first: a narrow terminal shows the beginning.
std::string refining_words(std::int64_t triangles, double forecast, double seconds) {
  const double left = forecast - static_cast<double>(triangles), rate = static_cast<double>(triangles) / seconds;
  const bool forecast_holds = left > 0 && forecast < 1e15;
  std::string text = "refining";
  if (forecast_holds)
    text += fmt::format("  {:2.0f} %", std::min(99.0, 100 * static_cast<double>(triangles) / forecast));
  if (forecast_holds && seconds > 0) text += fmt::format("  {} left", whole_seconds_words(left / rate));
  text += "  " + grouped(triangles);
  if (forecast_holds) text += " of about " + estimate_words(forecast);
  text += " triangles";
  if (seconds > 0) text += fmt::format("  {:.2f} million/s", rate / 1e6);
  return text;
}

bool ProgressLine::possible() {
  const char* const terminal = std::getenv("TERM");
  return isatty(STDERR_FILENO) == 1 && terminal != nullptr && std::string_view(terminal) != "dumb";
}

void ProgressLine::begin(const std::string& stage) {
  if (enabled_) show(stage, Clock::now());
}

void ProgressLine::refining(std::int64_t triangles, double forecast) {
  if (!enabled_) return;
  const Clock::time_point now = Clock::now();
  if (!refining_) refining_since_ = now;
  refining_ = true;
  if (now - last_ < kEvery) return;
  show(refining_words(triangles, forecast, std::chrono::duration<double>(now - refining_since_).count()), now);
}

void ProgressLine::show(const std::string& text, Clock::time_point now) {
  if (now - start_ < kFirstAfter) return;
  std::fprintf(stderr, "\r%s\033[K", text.substr(0, terminal_width() - 1).c_str());
  std::fflush(stderr);
  shown_ = true;
  last_ = now;
}

void ProgressLine::erase() {
  if (!shown_) return;
  std::fputs("\r\033[K", stderr);
  std::fflush(stderr);
  shown_ = false;
}

}  // namespace driftmesh::app
