#include "protocol/threads/thread_network.hpp"

#include <chrono>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <string>
#include <thread>
#include <utility>

#include "driftmesh/error.hpp"

namespace driftmesh::protocol {
namespace {

using Clock = std::chrono::steady_clock;

// After this many empty polls in a row a rank no longer yields its core, but sleeps until a message comes. Not for
// long: the rank may have reasons of its own to look around.
constexpr int kPatience = 200;
constexpr std::chrono::milliseconds kNap{1};

}  // namespace

/// The end of the network at one rank. Other ranks only put messages into its mailbox.
class ThreadNetwork::End final : public Transport {
 public:
  End(Rank rank, const IdVector<Rank, std::unique_ptr<End>>& ends) : rank_(rank), ends_(ends) {}

  [[nodiscard]] Rank rank() const override { return rank_; }
  [[nodiscard]] std::int32_t ranks() const override { return static_cast<std::int32_t>(ends_.size()); }

  void send(Rank destination, Bytes bytes) override {
    if (!ends_.has(destination))
      throw LimitError("rank " + to_string(rank_) + " sends to rank " + to_string(destination) + " of " +
                       std::to_string(ranks()));
    ends_[destination]->put({rank_, std::move(bytes)});
  }

  std::optional<Received> poll() override {
    if (taken_.empty()) {
      const std::lock_guard lock(mutex_);
      taken_.swap(mailbox_);
    }
    if (taken_.empty()) return std::nullopt;
    Received first = std::move(taken_.front());
    taken_.pop_front();
    idle_polls_ = 0;
    return first;
  }

  void idle() override {
    if (++idle_polls_ < kPatience) return std::this_thread::yield();
    std::unique_lock lock(mutex_);
    arrived_.wait_for(lock, kNap, [this] { return !mailbox_.empty(); });
  }

  [[nodiscard]] double now() const override {
    return std::chrono::duration<double>(Clock::now().time_since_epoch()).count();
  }

 private:
  void put(Received message) {
    {
      const std::lock_guard lock(mutex_);
      mailbox_.push_back(std::move(message));
    }
    arrived_.notify_one();
  }

  Rank rank_;
  const IdVector<Rank, std::unique_ptr<End>>& ends_;
  std::mutex mutex_;  // guards the mailbox
  std::condition_variable arrived_;
  std::deque<Received> mailbox_;
  std::deque<Received> taken_;  // out of it, by this rank
  int idle_polls_ = 0;
};

ThreadNetwork::ThreadNetwork(std::int32_t ranks) : ends_(to_index(ranks)) {
  for (const Rank r : ids_of(ends_)) ends_[r] = std::make_unique<End>(r, ends_);
}

ThreadNetwork::~ThreadNetwork() = default;

Transport& ThreadNetwork::transport(Rank rank) {
  return *ends_.at(rank);
}

}  // namespace driftmesh::protocol
