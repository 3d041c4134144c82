#include "runtime/threads/thread_crew.hpp"

#include <chrono>
#include <system_error>

#include "base/thread_place.hpp"
#include "runtime/threads/few_threads.hpp"

namespace driftmesh {

ThreadCrew::ThreadCrew(std::size_t threads) {
  try {
    for (std::size_t i = 0; i < threads; ++i) threads_.emplace_back([this, i] { work(i + 1); });
  } catch (const std::system_error&) {
    const std::size_t given = threads_.size() + 1;
    dismiss();
    throw too_few_threads(given, threads + 1);
  }
}

ThreadCrew::~ThreadCrew() {
  dismiss();
}

void ThreadCrew::dismiss() {
  {
    const std::scoped_lock lock(mutex_);
    over_ = true;
  }
  called_.notify_all();
  for (std::thread& thread : threads_) thread.join();
  threads_.clear();
}

void ThreadCrew::start(Shift& shift) {
  {
    const std::scoped_lock lock(mutex_);
    waiting_.push_back(&shift);
  }
  called_.notify_one();
}

Shift* ThreadCrew::finished() {
  const std::scoped_lock lock(mutex_);
  if (performed_.empty()) return nullptr;
  Shift* const shift = performed_.front();
  performed_.pop_front();
  return shift;
}

void ThreadCrew::wait() {
  constexpr auto kNotLong = std::chrono::microseconds(100);  // messages may be waiting, too
  std::unique_lock lock(mutex_);
  ended_.wait_for(lock, kNotLong, [this] { return !performed_.empty(); });
}

void ThreadCrew::work(std::size_t place) {
  thread_place() = place;
  std::unique_lock lock(mutex_);
  for (;;) {
    called_.wait(lock, [this] { return over_ || !waiting_.empty(); });
    if (waiting_.empty()) return;
    Shift* const shift = waiting_.front();
    waiting_.pop_front();
    lock.unlock();
    const auto begin = std::chrono::steady_clock::now();
    shift->perform();
    shift->seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    lock.lock();
    performed_.push_back(shift);
    ended_.notify_one();
  }
}

}  // namespace driftmesh
