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

std::string refining_words(std::int64_t triangles, double forecast, double seconds) {
  const double rate = seconds > 0 ? static_cast<double>(triangles) / seconds : 0;
  std::string text = fmt::format("refining  {:>13} triangles", grouped(triangles));
  if (forecast >= static_cast<double>(triangles) && forecast < 1e18)
    text = fmt::format("refining  {:>13} of about {} triangles  {:2.0f} %", grouped(triangles),
                       grouped(static_cast<std::int64_t>(forecast)),
                       std::min(99.0, 100 * static_cast<double>(triangles) / forecast));
  if (rate <= 0) return text;
  text += fmt::format("  {}/s", rate_words(rate));
  if (forecast > static_cast<double>(triangles))
    text += fmt::format("  {:.0f} s left", (forecast - static_cast<double>(triangles)) / rate);
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
