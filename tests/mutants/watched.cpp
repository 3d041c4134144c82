#include "mutants/watched.hpp"

#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>
#include <stdexcept>
#include <thread>
#include <vector>

#include "mutants/memory_limit.hpp"

namespace driftmesh::mutants {
namespace {

constexpr const char* kTooMuchMemory = "takes too much memory";

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// What a child tells: in memory that it shares with its parent.
struct Shared {
  std::atomic<std::uint64_t> seed{0};
  std::atomic<double> since{0};
  std::atomic<std::uint64_t> mutants{0}, accepted{0}, refused_though_declared{0}, failed{0};
  std::atomic<std::size_t> most_bytes{0};
  std::atomic<double> longest{0};
};

Shared* shared_memory(std::size_t count) {
  void* const memory =
      ::mmap(nullptr, count * sizeof(Shared), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) throw std::runtime_error("no shared memory");
  return new (memory) Shared[count];
}

template <class T>
void raise(std::atomic<T>& most, T value) {
  if (value > most) most = value;
}

class Watched {
 public:
  Watched(std::uint64_t first, std::uint64_t last, unsigned processes, const Limits& limits,
          const std::function<Result(std::uint64_t, unsigned)>& work,
          const std::function<void(std::uint64_t, const std::string&)>& report)
      : last_(last),
        step_(processes),
        limits_(limits),
        work_(work),
        report_(report),
        shared_(shared_memory(processes)),
        children_(processes, 0) {
    for (unsigned k = 0; k < processes; ++k) start(k, first + k);
  }

  Totals run() {
    while (running_ > 0) {
      for (unsigned k = 0; k < step_; ++k)
        if (children_[k] != 0) look_at(k);
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    Totals totals;
    for (unsigned k = 0; k < step_; ++k) {
      const Shared& shared = shared_[k];
      totals.mutants += shared.mutants;
      totals.accepted += shared.accepted;
      totals.refused_though_declared += shared.refused_though_declared;
      totals.failed += shared.failed;
      totals.most_bytes = std::max(totals.most_bytes, shared.most_bytes.load());
      totals.longest = std::max(totals.longest, shared.longest.load());
    }
    totals.refused = totals.mutants - totals.accepted - totals.failed;
    return totals;
  }

 private:
  void start(unsigned k, std::uint64_t seed) {
    if (seed > last_) return;
    shared_[k].seed = seed;
    shared_[k].since = now();
    std::fflush(nullptr);
    const pid_t child = ::fork();
    if (child < 0) throw std::runtime_error("cannot start a process");
    if (child == 0) {
      (void)::prctl(PR_SET_PDEATHSIG, SIGKILL);  // none goes on without its parent
      limit_memory(limits_.bytes);
      for (; seed <= last_; seed += step_) take(k, seed);
      shared_[k].seed = 0;
      std::exit(0);  // a sanitizer looks for leaks there
    }
    children_[k] = child;
    ++running_;
  }

  /// In a child.
  void take(unsigned k, std::uint64_t seed) {
    Shared& shared = shared_[k];
    shared.seed = seed;
    shared.since = now();
    start_measuring();
    const Result result = result_of(k, seed);
    raise(shared.most_bytes, most_measured());
    raise(shared.longest, now() - shared.since);
    ++shared.mutants;
    if (!result.failure.empty()) {
      ++shared.failed;
      report_(seed, result.failure);
    } else if (result.accepted) {
      ++shared.accepted;
    } else if (result.declared) {
      ++shared.refused_though_declared;
    }
  }

  Result result_of(unsigned k, std::uint64_t seed) {
    try {
      return work_(seed, k);
    } catch (const std::bad_alloc&) {
      return {false, false, kTooMuchMemory};
    } catch (const std::exception& error) {
      return {false, false, std::string("ends with an exception that is no driftmesh::Error: ") + error.what()};
    }
  }

  void look_at(unsigned k) {
    int status = 0;
    const bool hangs = now() - shared_[k].since > limits_.seconds && shared_[k].seed != 0;
    if (hangs) ::kill(children_[k], SIGKILL);
    if (::waitpid(children_[k], &status, hangs ? 0 : WNOHANG) != children_[k]) return;
    children_[k] = 0;
    --running_;
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return;
    const std::uint64_t seed = shared_[k].seed;
    ++shared_[k].failed;
    report_(seed, hangs ? "hangs" : words_of(status, seed));
    if (seed == 0) return;
    ++shared_[k].mutants;
    start(k, seed + step_);
  }

  static std::string words_of(int status, std::uint64_t seed) {
    if (WIFSIGNALED(status)) return "crashes with signal " + std::to_string(WTERMSIG(status));
    const int code = WEXITSTATUS(status);
    if (code == kMemoryExit) return kTooMuchMemory;
    return (seed == 0 ? "a process fails after its last mutant (a leak?), with exit code "
                      : "crashes with exit code ") +
           std::to_string(code);
  }

  std::uint64_t last_;
  unsigned step_;
  Limits limits_;
  const std::function<Result(std::uint64_t, unsigned)>& work_;
  const std::function<void(std::uint64_t, const std::string&)>& report_;
  Shared* shared_;
  std::vector<pid_t> children_;
  unsigned running_ = 0;
};

}  // namespace

Totals run_watched(std::uint64_t first, std::uint64_t last, unsigned processes, const Limits& limits,
                   const std::function<Result(std::uint64_t, unsigned)>& work,
                   const std::function<void(std::uint64_t, const std::string&)>& report) {
  return Watched(first, last, processes, limits, work, report).run();
}

}  // namespace driftmesh::mutants
