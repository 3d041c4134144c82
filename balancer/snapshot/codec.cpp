#include "balancer/snapshot/codec.hpp"

#include <string>

#include "driftmesh/error.hpp"
#include "protocol/protocol_error.hpp"

namespace driftmesh::balancer {
namespace {

using protocol::MessageOf;

constexpr std::size_t kReportedLoadBytes = 24, kMoveBytes = 8, kRankBytes = 4, kGuestBytes = 12;

void fields(auto& archive, MessageOf<ReportedLoad> auto& m) {
  archive.subdomain(m.subdomain);
  archive.number(m.epoch);
  archive.amount(m.remaining);
  archive.number(m.bytes);
}
void fields(auto& archive, MessageOf<LoadReport> auto& m) {
  archive.number(m.round);
  archive.number(m.plan);
  archive.amount(m.speed);
  archive.amount(m.doubt);
  archive.amount(m.unlisted);
  archive.amount(m.free_memory);
  archive.list(m.loads, kReportedLoadBytes, [](auto& a, auto& load) { fields(a, load); });
}
void fields(auto& archive, MessageOf<Move> auto& m) {
  archive.subdomain(m.subdomain);
  archive.rank(m.destination);
}
void fields(auto& archive, MessageOf<Plan> auto& m) {
  archive.number(m.round);
  archive.list(m.moves, kMoveBytes, [](auto& a, auto& move) { fields(a, move); });
  archive.list(m.ask, kRankBytes, [](auto& a, auto& rank) { a.rank(rank); });
}
void fields(auto& archive, MessageOf<LoadNews> auto& m) {
  archive.number(m.round);
  archive.amount(m.remaining);
  archive.amount(m.spare);
  archive.amount(m.speed);
  archive.amount(m.doubt);
  archive.amount(m.free_memory);
}
void fields(auto& archive, MessageOf<WorkRequest> auto& m) {
  archive.rank(m.thief);
  archive.number(m.round);
  archive.amount(m.remaining);
  archive.amount(m.speed);
  archive.number(m.rivals);
  archive.amount(m.doubt);
  archive.amount(m.free_memory);
  archive.amount(m.horizon);
}
void fields(auto& archive, MessageOf<WorkAnswer> auto& m) {
  archive.number(m.round);
  archive.list(m.moves, kMoveBytes, [](auto& a, auto& move) { fields(a, move); });
}
void fields(auto& archive, MessageOf<Admission::Guest> auto& m) {
  archive.subdomain(m.subdomain);
  archive.amount(m.triangles);
}
void fields(auto& archive, MessageOf<Admission> auto& m) {
  archive.number(m.round);
  archive.choice(m.stage, Admission::Stage::kReturn);
  archive.list(m.guests, kGuestBytes, [](auto& a, auto& guest) { fields(a, guest); });
}

}  // namespace

protocol::Advice encode(const Message& message) {
  protocol::WireWriter writer;
  std::visit([&](const auto& m) { fields(writer, m); }, message);
  return {static_cast<std::uint8_t>(message.index()), writer.take()};
}

Message decode(Rank sender, const protocol::Advice& advice, const protocol::WireLimits& limits) {
  return protocol::read_from(sender, [&] {
    if (advice.topic >= std::variant_size_v<Message>)
      throw Error("it is advice on the unknown topic " + std::to_string(advice.topic));
    protocol::WireReader reader(advice.content, limits);
    Message message = protocol::empty_message<Message>(advice.topic);
    std::visit([&](auto& m) { fields(reader, m); }, message);
    reader.end();
    return message;
  });
}

}  // namespace driftmesh::balancer
