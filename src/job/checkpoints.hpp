#pragma once

#include <atomic>
#include <cstdint>
#include <exception>
#include <functional>
#include <map>
#include <mutex>
#include <string>

#include "base/bytes.hpp"
#include "base/noted_signals.hpp"
#include "distributed/ranks.hpp"
#include "job/record.hpp"
#include "job/watch.hpp"
#include "runtime/threads/refinement_in_rounds.hpp"

namespace driftmesh::job {

/// The checkpoints of a run in rounds, and its ends before its time: each process comes to fences, where all agree on
/// what to do (fence.hpp). SIGUSR1 asks for a checkpoint now, SIGTERM for one and the end of the run, as a limit does.
class Checkpoints {
 public:
  struct Rules {
    std::string path;        ///< where the file is written
    double every = 0;        ///< seconds between two checkpoints
    double fence_every = 1;  ///< seconds between two fences, where there are several processes
    std::size_t subdomains = 0;
    std::function<void()> saving{};  ///< called again and again while a checkpoint is written; may be empty
  };
  /// `heads`: makes what the file says of the run besides its subdomains, on rank 0. `check_all`: throws LimitError if
  /// so many triangles of all processes are too many. `ranks` and `watch` outlive the object.
  Checkpoints(Rules rules, Ranks& ranks, std::function<std::map<std::string, Bytes>()> heads,
              std::function<void(std::int64_t triangles)> check_all, Watch& watch);

  /// Whether this process is to come to a fence. For any thread.
  [[nodiscard]] bool halts() const;
  /// This process has met a limit, as the exception says: the run ends at the next fence. For any thread.
  void end_for(std::exception_ptr why);

  /// At a fence: exchanges what all say, writes a checkpoint if one is wanted, and returns whether the round is over.
  /// The first checkpoint that cannot be written is a warning. Throws LimitError, which says how to go on, where the
  /// run ends. Collective.
  [[nodiscard]] bool fence(bool rests, const RefinementInRounds& refinement);

  [[nodiscard]] const CheckpointRecord& record() const { return record_; }

 private:
  [[nodiscard]] Bytes letter(bool rests, std::int64_t triangles);
  [[nodiscard]] bool is_due() const;
  [[nodiscard]] std::string save(const RefinementInRounds& refinement);
  [[noreturn]] void end(const std::exception_ptr& why, const std::string& fault);

  Rules rules_;
  Ranks& ranks_;
  std::function<std::map<std::string, Bytes>()> heads_;
  std::function<void(std::int64_t)> check_all_;
  Watch& watch_;
  NotedSignals signals_;
  double last_fence_, last_save_;  // when; read by threads, which end before a fence
  std::atomic<bool> ends_ = false;
  std::mutex alone_;
  std::exception_ptr why_;
  bool warned_ = false;
  CheckpointRecord record_;
};

}  // namespace driftmesh::job
