#pragma once

#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

#include "base/bytes.hpp"
#include "base/stopwatch.hpp"
#include "distributed/exchange.hpp"
#include "driftmesh/ids.hpp"

namespace driftmesh {

/// Those who work on a mesh together: this process by itself, or the ranks of a transport. All calls but rank(),
/// ranks(), now() and meanwhile() are collective, in the same order on all ranks.
class Ranks {
 public:
  virtual ~Ranks() = default;
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;

  [[nodiscard]] virtual Rank rank() const = 0;
  [[nodiscard]] virtual std::int32_t ranks() const = 0;
  [[nodiscard]] bool alone() const { return ranks() == 1; }
  /// Seconds since some moment in the past; in simulated time on simulated ranks.
  [[nodiscard]] virtual double now() const = 0;

  /// `look` is called again and again while this rank waits for others in a call; what it throws, only this rank
  /// throws.
  void meanwhile(std::function<void()> look) { meanwhile_ = std::move(look); }

  /// Performs a whole exchange.
  virtual void run(Exchange& exchange) = 0;

  /// The bytes of every rank, on every rank.
  [[nodiscard]] std::vector<Bytes> bytes_of_all(const Bytes& own);
  /// Sends mail, at most one to each rank, and returns that from `senders`, which are ascending.
  [[nodiscard]] std::vector<Mail> deliver(std::vector<Mail> mail, std::vector<Rank> senders);
  /// The same for ranks that send mail to each other: each gets some from those to which it sends some.
  [[nodiscard]] std::vector<Mail> swap(std::vector<Mail> mail);

  /// Each rank does its part, and if one of them fails, all throw the failure of the first one, with its number. One
  /// that is alone throws what the work throws.
  void agree(const std::function<void()>& work);
  /// Does work that throws on all ranks alike by means of its own.
  template <class Work>
  void alike(const Work& work) {
    try {
      work();
    } catch (...) {
      failed_together_ = true;
      throw;
    }
  }
  /// Whether one of these has thrown: then all ranks know of the failure.
  [[nodiscard]] bool have_failed_together() const { return failed_together_; }
  /// They go on nevertheless.
  void recovered() { failed_together_ = false; }

 protected:
  Ranks() = default;
  void look_up() const {
    if (meanwhile_) meanwhile_();
  }

 private:
  bool failed_together_ = false;
  std::function<void()> meanwhile_;
};

/// This process by itself.
class OneRank final : public Ranks {
 public:
  [[nodiscard]] Rank rank() const override { return Rank{0}; }
  [[nodiscard]] std::int32_t ranks() const override { return 1; }
  [[nodiscard]] double now() const override { return clock_.seconds(); }
  void run(Exchange& exchange) override;

 private:
  Stopwatch clock_;
};

/// The ranks of a transport, which nothing else uses meanwhile.
class RanksOfTransport final : public Ranks {
 public:
  explicit RanksOfTransport(protocol::Transport& transport) : transport_(transport), runner_(transport) {}
  [[nodiscard]] Rank rank() const override { return transport_.rank(); }
  [[nodiscard]] std::int32_t ranks() const override { return transport_.ranks(); }
  [[nodiscard]] double now() const override { return transport_.now(); }
  void run(Exchange& exchange) override;

 private:
  protocol::Transport& transport_;
  ExchangeRunner runner_;
};

}  // namespace driftmesh
