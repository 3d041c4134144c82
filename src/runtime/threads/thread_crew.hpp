#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <mutex>
#include <thread>
#include <vector>

#include "runtime/crew.hpp"

namespace driftmesh {

/// A crew of threads of this process. Each has a thread_place() of its own, from 1.
class ThreadCrew final : public Crew {
 public:
  /// Throws LimitError if the system does not give that many threads.
  explicit ThreadCrew(std::size_t threads);
  /// Waits for the shifts under way.
  ~ThreadCrew() override;

  [[nodiscard]] std::size_t size() const override { return threads_.size(); }
  void start(Shift& shift) override;
  [[nodiscard]] Shift* finished() override;
  void wait() override;

 private:
  void work(std::size_t place);
  void dismiss();

  std::mutex mutex_;  // guards the following three
  std::deque<Shift*> waiting_;
  std::deque<Shift*> performed_;
  bool over_ = false;
  std::condition_variable called_, ended_;
  std::vector<std::thread> threads_;
};

}  // namespace driftmesh
