#include "bench/child_process.hpp"

#include <malloc.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <exception>
#include <fstream>
#include <iostream>
#include <string>

#include "driftmesh/error.hpp"

namespace driftmesh::bench {
namespace {

/// Memory that a child shares with its parent.
class SharedBuffer {
 public:
  explicit SharedBuffer(std::size_t size)
      : data_(mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0)), size_(size) {
    if (data_ == MAP_FAILED) throw Error("cannot map memory to share with a child process");
  }
  SharedBuffer(const SharedBuffer&) = delete;
  SharedBuffer& operator=(const SharedBuffer&) = delete;
  ~SharedBuffer() { munmap(data_, size_); }
  [[nodiscard]] void* data() const { return data_; }

 private:
  void* data_;
  std::size_t size_;
};

[[noreturn]] void be_child(const std::function<void(void*)>& fill, void* buffer) {
  int code = 0;
  try {
    fill(buffer);
  } catch (const std::exception& error) {
    std::cerr << "driftmesh_bench: " << error.what() << std::endl;
    code = 1;
  }
  _exit(code);  // the child must not flush the parent's buffers or run its handlers
}

}  // namespace

void run_in_child(const std::function<void(void*)>& fill, void* result, std::size_t size) {
  const SharedBuffer buffer(size);
  std::cout.flush();
  malloc_trim(0);  // memory freed by the parent must not count as the child's
  const pid_t child = fork();
  if (child < 0) throw Error("cannot fork a process for a run");
  if (child == 0) be_child(fill, buffer.data());
  int status = 0;
  waitpid(child, &status, 0);
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
    throw Error("a run failed" + (WIFSIGNALED(status) ? " with signal " + std::to_string(WTERMSIG(status)) : ""));
  std::copy_n(static_cast<const std::byte*>(buffer.data()), size, static_cast<std::byte*>(result));
}

std::int64_t peak_memory() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("VmHWM:")) return 1024 * std::stoll(line.substr(6));
  return 0;
}

}  // namespace driftmesh::bench
