#include "protocol/codec.hpp"

#include <algorithm>
#include <string>

#include "base/narrow.hpp"

namespace driftmesh::protocol {
namespace {

constexpr std::size_t kAdvice = std::variant_size_v<Message> - 1;
static_assert(std::is_same_v<std::variant_alternative_t<kAdvice, Message>, Advice>);

void fields(auto& archive, MessageOf<SplitPoint<GlobalRootId>> auto& m) {
  archive.root(m.root);
  archive.path(m.path);
}
void fields(auto& archive, MessageOf<SplitGroup> auto& m) {
  archive.subdomain(m.to);
  archive.number(m.epoch);
  archive.rank(m.origin);
  archive.number(m.hops);
  archive.list(m.points, kSplitPointBytes, [](auto& a, auto& point) { fields(a, point); });
}
void fields(auto& archive, MessageOf<SplitBatch> auto& m) {
  archive.list(m.groups, kSplitGroupBytes, [](auto& a, auto& group) { fields(a, group); });
}
void fields(auto& archive, MessageOf<HandOff> auto& m) {
  archive.subdomain(m.subdomain);
  archive.number(m.epoch);
  archive.rest(m.packed);
}
void fields(auto& archive, MessageOf<LocationUpdate> auto& m) {
  archive.subdomain(m.subdomain);
  archive.rank(m.owner);
  archive.number(m.epoch);
}
void fields(auto& archive, MessageOf<Token> auto& m) {
  archive.number(m.round);
  archive.number(m.count);
  archive.flag(m.black);
}
void fields(auto& archive, MessageOf<Terminate> auto& m) {
  archive.number(m.round);
  archive.number(m.work);
  archive.number(m.control);
}
void fields(auto&, MessageOf<Finish> auto&) {}
void fields(auto&, MessageOf<Abandon> auto&) {}
void fields(auto& archive, MessageOf<Advice> auto& m) {
  archive.rest(m.content);
}

std::uint8_t type_of(const Message& message) {
  const auto* const advice = std::get_if<Advice>(&message);
  return narrow<std::uint8_t>(message.index() + (advice != nullptr ? advice->topic : 0), "the topic of advice");
}

// An empty message of the type given by the two leading bytes of every message.
Message read_head(WireReader& reader) {
  std::uint8_t version = 0, type = 0;
  reader.number(version);
  if (version != kWireVersion)
    throw Error("it has version " + std::to_string(version) + ", but this program uses " +
                std::to_string(kWireVersion) + "; start the same build on every rank");
  reader.number(type);
  Message message = empty_message<Message>(std::min<std::size_t>(type, kAdvice));
  if (auto* const advice = std::get_if<Advice>(&message)) advice->topic = static_cast<std::uint8_t>(type - kAdvice);
  return message;
}

}  // namespace

Bytes encode(const Message& message) {
  WireWriter writer;
  writer.number(kWireVersion);
  writer.number(type_of(message));
  std::visit([&](const auto& m) { fields(writer, m); }, message);
  return writer.take();
}

Message decode(Rank sender, std::span<const std::byte> bytes, const WireLimits& limits) {
  return read_from(sender, [&] {
    WireReader reader(bytes, limits);
    Message message = read_head(reader);
    std::visit([&](auto& m) { fields(reader, m); }, message);
    reader.end();
    return message;
  });
}

Traffic traffic_of(const Message& message) {
  if (std::holds_alternative<SplitBatch>(message) || std::holds_alternative<HandOff>(message)) return Traffic::kWork;
  if (std::holds_alternative<Token>(message) || std::holds_alternative<Terminate>(message) ||
      std::holds_alternative<Finish>(message))
    return Traffic::kDetection;
  return Traffic::kControl;
}

Traffic traffic_of(Rank sender, std::span<const std::byte> bytes) {
  return read_from(sender, [&] {
    WireReader reader(bytes, {});
    return traffic_of(read_head(reader));
  });
}

}  // namespace driftmesh::protocol
