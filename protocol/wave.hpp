#pragma once

#include <algorithm>
#include <bitset>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "driftmesh/ids.hpp"
#include "protocol/messages.hpp"
#include "protocol/protocol_error.hpp"

namespace driftmesh::protocol {

/// The place of a rank in the tree of all ranks, whose root is rank 0: the children of r are kr + 1 to kr + k. So no
/// rank is more than log_k(P) + 1 messages from the root, and none has to hear from more than k others. The
/// tree is wide: some dozens of messages, a microsecond each, take no longer than the latency of one more level.
class TreePlace {
 public:
  static constexpr std::int32_t kMostChildren = 64;

  /// `arity`, from 1 to kMostChildren, is the k of all ranks.
  TreePlace(Rank self, std::int32_t ranks, std::int32_t arity)
      : self_(self), arity_(arity), first_(to_int(self) * std::int64_t{arity} + 1) {
    count_ = static_cast<std::int32_t>(std::clamp<std::int64_t>(ranks - first_, 0, arity));
  }
  [[nodiscard]] bool is_root() const { return self_ == Rank{0}; }
  /// Not of the root.
  [[nodiscard]] Rank parent() const { return Rank{(to_int(self_) - 1) / arity_}; }
  [[nodiscard]] std::size_t children() const { return static_cast<std::size_t>(count_); }
  [[nodiscard]] Rank child(std::size_t i) const {
    return Rank{static_cast<std::int32_t>(first_) + static_cast<std::int32_t>(i)};
  }
  /// Which child `rank` is, if any.
  [[nodiscard]] std::optional<std::size_t> child_number(Rank rank) const {
    const std::int64_t i = to_int(rank) - first_;
    if (i < 0 || i >= count_) return std::nullopt;
    return static_cast<std::size_t>(i);
  }

 private:
  Rank self_;
  std::int32_t arity_;
  std::int64_t first_;  // child; beyond the ranks of any run where there is none
  std::int32_t count_;
};

/// One rank's part in waves: rank 0 asks all ranks something, and the sum of their answers comes back. A question goes
/// down the tree at once. An answer goes up when the ranks below have answered and this one is ready. One wave follows
/// another, numbered from 1, so copies of messages are recognized. A question is an empty `Answer`, which must have a
/// `round` and `+=`.
template <class Answer>
class Wave {
 public:
  Wave(Rank self, std::int32_t ranks, std::int32_t arity) : place_(self, ranks, arity) {}

  [[nodiscard]] const TreePlace& place() const { return place_; }
  [[nodiscard]] std::uint64_t round() const { return round_; }  ///< number of the last question
  /// Whether a question is here that this rank has not answered.
  [[nodiscard]] bool asked() const { return asked_; }
  /// Whether it can be answered: all ranks below have done so.
  [[nodiscard]] bool due() const { return asked_ && answered_.count() == place_.children(); }

  /// The sum of the answers that have come from below.
  [[nodiscard]] const Answer& so_far() const { return sum_; }

  /// Asks, at the root, the next question.
  void ask() { begin(round_ + 1); }

  /// Returns whether it was a new question. Ignores copies; throws ProtocolError for a message that is not due.
  bool receive(Rank source, const Answer& answer) {
    if (const auto child = place_.child_number(source)) {
      if (answer.round > round_) not_due(source, answer);
      if (answer.round == round_) gather(*child, answer);
      return false;
    }
    if (place_.is_root() || source != place_.parent() || answer.round > round_ + 1) not_due(source, answer);
    const bool is_new = answer.round == round_ + 1;
    if (is_new) begin(answer.round);
    return is_new;
  }

  /// Passes a new question on to the ranks below.
  void relay(std::vector<Outgoing>& out) {
    if (!std::exchange(relay_due_, false)) return;
    for (std::size_t i = 0; i < place_.children(); ++i) out.push_back({place_.child(i), question()});
  }

  /// The sum of the answers of this rank and those below, when due.
  Answer close(Answer own) {
    asked_ = false;
    sum_ += own;
    return sum_;
  }
  void answer(const Answer& own, std::vector<Outgoing>& out) { out.push_back({place_.parent(), close(own)}); }

 private:
  [[nodiscard]] Answer question() const {
    Answer empty;
    empty.round = round_;
    return empty;
  }
  void begin(std::uint64_t round) {
    round_ = round;
    asked_ = relay_due_ = true;
    answered_.reset();
    sum_ = question();
  }
  void gather(std::size_t child, const Answer& answer) {
    if (answered_.test(child)) return;
    answered_.set(child);
    sum_ += answer;
  }
  [[noreturn]] static void not_due(Rank source, const Answer& answer) {
    throw ProtocolError(source,
                        std::string(Answer::kName) + " of round " + std::to_string(answer.round) + " is not due");
  }

  TreePlace place_;
  std::uint64_t round_ = 0;
  bool asked_ = false;
  bool relay_due_ = false;
  std::bitset<TreePlace::kMostChildren> answered_;
  Answer sum_;
};

}  // namespace driftmesh::protocol
