#include "job/order.hpp"

#include <string>
#include <utility>

#include "base/bytes.hpp"
#include "runtime/plan_bytes.hpp"

namespace driftmesh::job {
namespace {

enum class Letter : std::uint8_t { kOrder, kNothing, kError };

// The fields besides plan and input, in one order for both directions.
template <class Stream, class Fields>
void transfer_rest(Stream& stream, Fields& order) {
  stream.value(order.sizing.gradation);
  stream.value(order.sizing.shortest);
  stream.value(order.sizing.longest);
  stream.value(order.limits);
  stream.array(order.shares);
  stream.value(order.writes);
}

Bytes pack(const Order& order) {
  ByteWriter writer;
  writer.value(Letter::kOrder);
  writer.array(plan_to_bytes(order.plan));
  writer.array(pslg_to_bytes(order.pslg));
  writer.text(order.sizing.expression);
  writer.text(order.sizing.background);
  transfer_rest(writer, order);
  return writer.take();
}

Order unpack(ByteReader& reader, std::int32_t ranks, const std::shared_ptr<const balancer::Policy>& policy) {
  Order order;
  Bytes plan, pslg;
  reader.array(plan);
  reader.array(pslg);
  order.plan = plan_from_bytes(plan, ranks, policy);
  order.pslg = pslg_from_bytes(pslg);
  order.sizing.expression = reader.text();
  order.sizing.background = reader.text();
  transfer_rest(reader, order);
  return order;
}

Bytes nothing() {
  ByteWriter writer;
  writer.value(Letter::kNothing);
  return writer.take();
}

Bytes error(const char* message) {
  ByteWriter writer;
  writer.value(Letter::kError);
  writer.text(message);
  return writer.take();
}

/// What rank 0 says. Where making the order fails, it says so before it throws.
Bytes words_of_leader(Team& team, const std::function<std::optional<Order>()>& make) {
  try {
    const std::optional<Order> order = make();
    return order ? pack(*order) : nothing();
  } catch (const std::exception& failure) {
    static_cast<void>(team.broadcast(error(failure.what())));
    throw;
  }
}

}  // namespace

std::optional<Order> share(Team& team, const std::function<std::optional<Order>()>& make,
                           const std::shared_ptr<const balancer::Policy>& policy) {
  const Bytes bytes = team.broadcast(team.leads() ? words_of_leader(team, make) : Bytes());
  ByteReader reader(bytes);
  switch (reader.value<Letter>()) {
    case Letter::kOrder:
      return by_itself(team, [&] { return std::optional(unpack(reader, team.ranks(), policy)); });
    case Letter::kNothing:
      return std::nullopt;
    case Letter::kError:
      break;
  }
  throw LeaderError(reader.text());
}

}  // namespace driftmesh::job
