#include "distributed/exchange.hpp"

#include <algorithm>
#include <string>
#include <utility>

namespace driftmesh {

using protocol::Bytes;
using protocol::ProtocolError;
using protocol::Rank;
using protocol::StepResult;

namespace {

/// In front of every message: what it is, then its round.
constexpr std::uint32_t kMark = 0x31584d44;  // "DMX1"

}  // namespace

void ExchangeRunner::run(Exchange& exchange) {
  protocol::run_rank(transport_, [&] { return step(exchange); });
}

StepResult ExchangeRunner::step(Exchange& exchange) {
  if (round_ == exchange.rounds()) return round_ = 0, StepResult::kFinished;
  if (!sent_) begin_round(exchange);
  if (end_round(exchange)) return StepResult::kBusy;
  auto message = transport_.poll();
  if (!message) return StepResult::kIdle;
  keep(std::move(*message));
  return StepResult::kBusy;
}

void ExchangeRunner::begin_round(Exchange& exchange) {
  for (Mail& mail : exchange.send(round_)) {
    ByteWriter writer;
    writer.value(kMark);
    writer.value(serial_);
    writer.array(mail.bytes);
    transport_.send(mail.rank, writer.take());
  }
  senders_ = exchange.senders(round_);
  sent_ = true;
}

/// False while messages are missing.
bool ExchangeRunner::end_round(Exchange& exchange) {
  auto& arrived = arrived_[serial_];
  if (arrived.size() < senders_.size()) return false;
  std::vector<Mail> mail;
  for (auto& [source, bytes] : arrived) {
    if (!std::binary_search(senders_.begin(), senders_.end(), source))
      throw ProtocolError(source, "nothing was due from it in round " + std::to_string(serial_));
    mail.push_back({source, std::move(bytes)});
  }
  arrived_.erase(serial_++);
  sent_ = false;
  exchange.receive(round_++, std::move(mail));
  return true;
}

void ExchangeRunner::keep(protocol::Received message) {
  std::uint32_t mark = 0, serial = 0;
  Bytes bytes;
  read_mail({message.source, std::move(message.bytes)}, [&](ByteReader& reader) {
    reader.value(mark);
    if (mark != kMark) throw Error("it is not of an exchange in rounds");
    reader.value(serial);
    reader.array(bytes);
  });
  if (serial < serial_) throw ProtocolError(message.source, "it comes after its round " + std::to_string(serial));
  if (!arrived_[serial].emplace(message.source, std::move(bytes)).second)
    throw ProtocolError(message.source, "it is its second of round " + std::to_string(serial));
}

void exchange_directly(std::span<Exchange* const> ranks) {
  if (ranks.empty()) return;
  for (int round = 0; round < ranks[0]->rounds(); ++round) {
    std::vector<std::vector<Mail>> boxes(ranks.size());
    for (std::size_t r = 0; r < ranks.size(); ++r)
      for (Mail& mail : ranks[r]->send(round))
        boxes.at(static_cast<std::size_t>(mail.rank)).push_back({static_cast<Rank>(r), std::move(mail.bytes)});
    for (std::size_t r = 0; r < ranks.size(); ++r) {
      std::vector<Rank> sources;
      for (const Mail& mail : boxes[r]) sources.push_back(mail.rank);
      if (sources != ranks[r]->senders(round))
        throw Error("rank " + std::to_string(r) + " has messages from other ranks than it expects, in round " +
                    std::to_string(round));
      ranks[r]->receive(round, std::move(boxes[r]));
    }
  }
}

}  // namespace driftmesh
