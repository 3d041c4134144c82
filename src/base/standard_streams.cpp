#include "base/standard_streams.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <utility>

#include "driftmesh/error.hpp"

namespace driftmesh {
namespace {

bool is_taken = false;  // standard output, by a file

bool is_open(int descriptor) {
  return ::fcntl(descriptor, F_GETFD) != -1 || errno != EBADF;
}

[[noreturn]] void fail() {
  throw FileError("standard output", "cannot write");
}

}  // namespace

bool is_standard_stream(std::string_view path) {
  return path == "-" || (path.starts_with("-.") && path.find('/') == std::string_view::npos);
}

// A descriptor opened for the other direction fails like a closed one. open() takes the lowest that is free.
void hold_closed_streams() {
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (!is_open(descriptor)) static_cast<void>(::open("/dev/null", descriptor == STDIN_FILENO ? O_WRONLY : O_RDONLY));
}

void mute_standard_output() {
  const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
  if (nowhere == -1) return;
  static_cast<void>(::dup2(nowhere, STDOUT_FILENO));
  static_cast<void>(::close(nowhere));
}

bool take_standard_output() {
  return !std::exchange(is_taken, true);
}

void print(std::string_view text) {
  errno = 0;
  const std::size_t written = std::fwrite(text.data(), 1, text.size(), is_taken ? stderr : stdout);
  if (written != text.size() && !is_taken) fail();
}

void flush_standard_output() {
  errno = 0;
  const bool failed = std::fflush(stdout) != 0 || std::ferror(stdout) != 0;
  std::clearerr(stdout);
  if (failed) fail();
}

}  // namespace driftmesh
