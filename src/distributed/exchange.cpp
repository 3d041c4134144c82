#include "distributed/exchange.hpp"

#include <algorithm>
#include <string>
#include <utility>

namespace driftmesh {

using protocol::ProtocolError;
using protocol::StepResult;

namespace {

/// The header of every message: a mark, its round, its part number, and the number of parts.
constexpr std::uint32_t kMark = 0x32584d44;  // "DMX2"

constexpr std::uint32_t kMostParts = 1 << 20;

}  // namespace

Bytes ExchangeRunner::Arriving::joined() && {
  std::size_t size = 0;
  for (const Bytes& part : parts) size += part.size();
  Bytes all = std::move(parts[0]);
  all.reserve(size);
  for (std::size_t i = 1; i < parts.size(); ++i) {
    all.insert(all.end(), parts[i].begin(), parts[i].end());
    parts[i] = {};
  }
  return all;
}

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
  for (const Mail& mail : exchange.send(round_)) send(mail);
  senders_ = exchange.senders(round_);
  sent_ = true;
}

void ExchangeRunner::send(const Mail& mail) {
  const std::span<const std::byte> all(mail.bytes);
  const auto parts = static_cast<std::uint32_t>(std::max<std::size_t>((all.size() + part_ - 1) / part_, 1));
  for (std::uint32_t i = 0; i < parts; ++i) {
    const std::size_t begin = i * part_;
    const auto part = all.subspan(begin, std::min(part_, all.size() - begin));
    ByteWriter writer;
    writer.value(kMark);
    writer.value(serial_);
    writer.value(i);
    writer.value(parts);
    writer.array(part);
    transport_.send(mail.rank, writer.take());
  }
}

/// False while messages are missing.
bool ExchangeRunner::end_round(Exchange& exchange) {
  Arrivals& arrived = arrived_[serial_];
  if (arrived.size() < senders_.size()) return false;
  if (std::any_of(arrived.begin(), arrived.end(), [](const auto& a) { return a.second.missing > 0; })) return false;
  std::vector<Mail> mail;
  for (auto& [source, arriving] : arrived) {
    if (!std::binary_search(senders_.begin(), senders_.end(), source))
      throw ProtocolError(source, "no message was expected from it in round " + std::to_string(serial_));
    mail.push_back({source, std::move(arriving).joined()});
  }
  arrived_.erase(serial_++);
  sent_ = false;
  exchange.receive(round_++, std::move(mail));
  return true;
}

void ExchangeRunner::keep(protocol::Received message) {
  std::uint32_t serial = 0, part = 0, parts = 0;
  Bytes bytes;
  read_mail({message.source, std::move(message.bytes)}, [&](ByteReader& reader) {
    if (reader.value<std::uint32_t>() != kMark) throw Error("it is not part of an exchange in rounds");
    reader.value(serial);
    reader.value(part);
    reader.value(parts);
    if (part >= parts || parts > kMostParts)
      throw Error("it is part " + std::to_string(part) + " of " + std::to_string(parts));
    reader.array(bytes);
  });
  if (serial < serial_) throw ProtocolError(message.source, "it comes after its round " + std::to_string(serial));
  const auto [at, first] = arrived_[serial].try_emplace(message.source);
  Arriving& arriving = at->second;
  if (first) arriving = {std::vector<Bytes>(parts), std::vector<bool>(parts, false), parts};
  if (parts != arriving.parts.size() || arriving.there[part])
    throw ProtocolError(message.source, "it is its second of round " + std::to_string(serial));
  arriving.parts[part] = std::move(bytes);
  arriving.there[part] = true;
  --arriving.missing;
}

void exchange_directly(IdSpan<Rank, Exchange* const> ranks) {
  if (ranks.empty()) return;
  for (int round = 0; round < ranks.front()->rounds(); ++round) {
    IdVector<Rank, std::vector<Mail>> boxes(ranks.size());
    for (const Rank r : ids_of(ranks))
      for (Mail& mail : ranks[r]->send(round)) boxes.at(mail.rank).push_back({r, std::move(mail.bytes)});
    for (const Rank r : ids_of(ranks)) {
      std::vector<Rank> sources;
      for (const Mail& mail : boxes[r]) sources.push_back(mail.rank);
      if (sources != ranks[r]->senders(round))
        throw Error("rank " + to_string(r) + " has messages from other ranks than it expects, in round " +
                    std::to_string(round));
      ranks[r]->receive(round, std::move(boxes[r]));
    }
  }
}

}  // namespace driftmesh
