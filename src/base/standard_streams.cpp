#include "base/standard_streams.hpp"

#ifndef DRIFTMESH_PORTABLE
#include <fcntl.h>
#include <unistd.h>
#endif

#include <cerrno>
#include <cstdio>
#include <utility>

#include "driftmesh/error.hpp"

namespace driftmesh {
namespace {

bool is_taken = false;  // standard output, by a file

[[noreturn]] void fail() {
  throw FileError("standard output", "cannot write");
}

}  // namespace

bool is_standard_stream(std::string_view path) {
  return path == "-" || (path.starts_with("-.") && path.find('/') == std::string_view::npos);
}

#ifdef DRIFTMESH_PORTABLE

void hold_closed_streams() {}

void mute_standard_output() {
  std::fclose(stdout);
}

#else

namespace {

bool is_open(int descriptor) {
  return ::fcntl(descriptor, F_GETFD) != -1 || errno != EBADF;
}

}  // namespace

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

#endif

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
