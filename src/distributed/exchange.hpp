#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "base/bytes.hpp"
#include "driftmesh/error.hpp"
#include "driftmesh/ids.hpp"
#include "protocol/protocol_error.hpp"
#include "protocol/rank_step.hpp"
#include "protocol/transport.hpp"

namespace driftmesh {

/// A message and the rank at the other end: its destination or its source.
struct Mail {
  Rank rank{};
  Bytes bytes;
};

/// The ranks 0 .. ranks - 1.
[[nodiscard]] inline std::vector<Rank> all_ranks(std::int32_t ranks) {
  const auto all = first_ids<Rank>(ranks);
  return {all.begin(), all.end()};
}

/// Lets `read(ByteReader&)` read a message, which it must read to the end. An Error becomes a ProtocolError that names
/// the sender.
template <class Read>
void read_mail(const Mail& mail, const Read& read) {
  protocol::read_from(mail.rank, [&] {
    ByteReader reader(mail.bytes);
    read(reader);
    reader.end();
  });
}

/// One rank's part of an exchange in rounds: in each round, ranks send at most one message to each rank (themselves
/// included), then handle the messages sent to them. An exchange decides what to send; delivery is the task of a
/// Transport, or direct between ranks of one process.
class Exchange {
 public:
  virtual ~Exchange() = default;
  Exchange(const Exchange&) = delete;
  Exchange& operator=(const Exchange&) = delete;

  [[nodiscard]] virtual int rounds() const = 0;
  /// The messages of this rank in a round. Called in ascending order of rounds, each after the previous one was
  /// received.
  [[nodiscard]] virtual std::vector<Mail> send(int round) = 0;
  /// The ranks that send to this rank in this round, ascending. Called after send(round).
  [[nodiscard]] virtual std::vector<Rank> senders(int round) const = 0;
  /// `mail` is sorted by rank and has one message from each sender. Throws Error for invalid messages.
  virtual void receive(int round, std::vector<Mail> mail) = 0;

 protected:
  Exchange() = default;
};

/// A rank that performs exchanges over a Transport, one after another. Rounds are numbered consecutively over all
/// exchanges, so a message from a rank that is ahead waits until its round. Nothing else may use the transport
/// meanwhile; with MPI, create one for this purpose.
class ExchangeRunner {
 public:
  static constexpr std::size_t kPart = std::size_t{1} << 30;  ///< MPI counts the bytes of a message with an int

  /// Messages longer than `part` bytes are sent in parts of that length.
  explicit ExchangeRunner(protocol::Transport& transport, std::size_t part = kPart)
      : transport_(transport), part_(part) {}

  /// Performs a whole exchange. Every rank makes the same sequence of calls. Throws ProtocolError for a message that is
  /// not part of an exchange or was not expected.
  void run(Exchange& exchange);
  /// One step of an exchange, for simulated ranks: kFinished when it is over.
  protocol::StepResult step(Exchange& exchange);

 private:
  /// The parts of a message that have arrived.
  struct Arriving {
    std::vector<Bytes> parts;
    std::vector<bool> there;
    std::size_t missing = 0;

    [[nodiscard]] Bytes joined() &&;
  };
  using Arrivals = std::map<Rank, Arriving>;

  void begin_round(Exchange& exchange);
  bool end_round(Exchange& exchange);
  void send(const Mail& mail);
  void keep(protocol::Received message);

  protocol::Transport& transport_;
  std::size_t part_;
  int round_ = 0;  // number within the current exchange
  bool sent_ = false;
  std::vector<Rank> senders_;
  std::uint32_t serial_ = 0;                   // number of the current round, over all exchanges
  std::map<std::uint32_t, Arrivals> arrived_;  // by round and sender
};

/// A whole exchange between ranks of this process, ranks[r] being rank r.
void exchange_directly(IdSpan<Rank, Exchange* const> ranks);

}  // namespace driftmesh
