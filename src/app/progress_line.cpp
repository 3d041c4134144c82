#include "app/progress_line.hpp"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string_view>

#include "base/bytes_written.hpp"
#include "base/words.hpp"

namespace driftmesh::app {
namespace {

constexpr auto kFirstAfter = std::chrono::milliseconds(500);
constexpr auto kEvery = std::chrono::milliseconds(100);

constexpr std::chrono::seconds kFirstLineAfter{5}, kLineAtLeastEvery{60};

/// Whether stderr is a terminal that can rewrite a line.
bool rewrites_lines() {
  const char* const terminal = std::getenv("TERM");
  return isatty(STDERR_FILENO) == 1 && terminal != nullptr && std::string_view(terminal) != "dumb";
}

std::size_t terminal_width() {
  winsize size{};
  return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

double seconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

}  // namespace

// The most important part comes first: a narrow terminal shows only the beginning.
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
  if (seconds > 0) text += fmt::format("  {:.2f} M/s", rate / 1e6);
  return text;
}

std::string writing_words(const std::string& path, double seconds, std::uint64_t bytes) {
  std::string text = "writing " + std::filesystem::path(path).filename().string();
  if (seconds >= 1) text += fmt::format("  {:.0f} s", seconds);
  if (bytes > 0) text += "  " + bytes_words(bytes);
  if (bytes > 0 && seconds >= 1)
    text += fmt::format("  {}/s", bytes_words(static_cast<std::uint64_t>(static_cast<double>(bytes) / seconds)));
  return text;
}

ProgressLine::ProgressLine(bool enabled)
    : rewrites_(rewrites_lines()), due_(Clock::now() + (rewrites_ ? Clock::duration(kFirstAfter) : kFirstLineAfter)) {
  if (enabled) thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
}

void ProgressLine::begin(const std::string& stage) {
  const std::lock_guard lock(mutex_);
  stage_ = stage;
  file_.clear();
  since_ = stage_since_ = Clock::now();
  refining_ = false;
  due_ = std::min<Clock::time_point>(due_, since_ + kFirstLineAfter);
  wake_.notify_all();
}

void ProgressLine::writing(const std::string& path) {
  const std::lock_guard lock(mutex_);
  file_ = path;
  since_ = Clock::now();
  written_before_ = bytes_written();
}

void ProgressLine::refining(std::int64_t triangles, double forecast) {
  const std::lock_guard lock(mutex_);
  if (!refining_) since_ = Clock::now();
  refining_ = true;
  triangles_ = triangles;
  forecast_ = forecast;
}

void ProgressLine::write(const std::string& text) {
  const std::lock_guard lock(mutex_);
  erase();
  std::fputs(text.c_str(), stderr);
}

void ProgressLine::end() {
  if (!thread_.joinable()) return;
  thread_.request_stop();
  thread_.join();
  erase();
}

void ProgressLine::run(const std::stop_token& stop) {
  const Clock::time_point begin = Clock::now();
  std::unique_lock lock(mutex_);
  while (true) {
    while (!stop.stop_requested() && Clock::now() < due_)
      wake_.wait_until(lock, stop, due_, [this, due = due_] { return due_ != due; });
    if (stop.stop_requested()) return;
    if (rewrites_)
      rewrite_line();
    else
      std::fprintf(stderr, "[%s] %s\n", whole_seconds_words(seconds_since(begin) - 0.5).c_str(), text().c_str());
    due_ = Clock::now() + next_wait();
  }
}

// The interval between lines is the age of the stage.
ProgressLine::Clock::duration ProgressLine::next_wait() const {
  if (rewrites_) return kEvery;
  return std::clamp<Clock::duration>(Clock::now() - stage_since_, kFirstLineAfter, kLineAtLeastEvery);
}

std::string ProgressLine::text() const {
  const double seconds = seconds_since(since_);
  if (refining_) return refining_words(triangles_, forecast_, seconds);
  if (!file_.empty()) return writing_words(file_, seconds, bytes_written() - written_before_);
  return seconds >= 1 ? fmt::format("{}  {:.0f} s", stage_, seconds) : stage_;
}

void ProgressLine::rewrite_line() {
  std::fprintf(stderr, "\r%s\033[K", text().substr(0, terminal_width() - 1).c_str());
  std::fflush(stderr);
  shown_ = true;
}

void ProgressLine::erase() {
  if (!shown_) return;
  std::fputs("\r\033[K", stderr);
  std::fflush(stderr);
  shown_ = false;
}

}  // namespace driftmesh::app
