#include "job/order.hpp"

#include <exception>
#include <string>
#include <utility>

#include "base/bytes.hpp"
#include "base/failure.hpp"
#include "runtime/plan_bytes.hpp"

namespace driftmesh::job {
namespace {

enum class Letter : std::uint8_t { kOrder, kNothing, kError };

// The fields other than plan and input, in the same order for writing and reading.
template <class Stream, class Fields>
void transfer_rest(Stream& stream, Fields& order) {
  stream.value(order.sizing.gradation);
  stream.value(order.sizing.shortest);
  stream.value(order.sizing.longest);
  stream.value(order.sizing.resolution);
  stream.value(order.limits);
  stream.array(order.shares);
  stream.value(order.use);
}

Bytes pack(const Order& order) {
  ByteWriter writer;
  writer.value(Letter::kOrder);
  writer.array(plan_to_bytes(order.plan));
  writer.array(pslg_to_bytes(order.pslg));
  writer.text(order.sizing.expression);
  writer.text(order.sizing.background);
  transfer_rest(writer, order);
  writer.text(order.scratch);
  return writer.take();
}

Order unpack(ByteReader& reader, std::int32_t ranks, const balancer::PolicyMaker& policies) {
  Order order;
  Bytes plan, pslg;
  reader.array(plan);
  reader.array(pslg);
  order.plan = plan_from_bytes(plan, ranks, policies);
  order.pslg = pslg_from_bytes(pslg);
  order.sizing.expression = reader.text();
  order.sizing.background = reader.text();
  transfer_rest(reader, order);
  order.scratch = reader.text();
  return order;
}

Bytes nothing() {
  ByteWriter writer;
  writer.value(Letter::kNothing);
  return writer.take();
}

Bytes error(const Failure& failure) {
  ByteWriter writer;
  writer.value(Letter::kError);
  failure.write(writer);
  return writer.take();
}

/// What rank 0 broadcasts. If making the order fails, it broadcasts the error before it throws.
Bytes leader_bytes(Team& team, const std::function<std::optional<Order>()>& make) {
  try {
    const std::optional<Order> order = make();
    return order ? pack(*order) : nothing();
  } catch (const std::exception&) {
    static_cast<void>(team.broadcast(error(failure_of(std::current_exception()))));
    throw;
  }
}

}  // namespace

std::optional<Order> share(Team& team, const std::function<std::optional<Order>()>& make,
                           const balancer::PolicyMaker& policies) {
  const Bytes bytes = team.broadcast(team.leads() ? leader_bytes(team, make) : Bytes());
  ByteReader reader(bytes);
  switch (reader.value<Letter>()) {
    case Letter::kOrder:
      return by_itself(team, [&] { return std::optional(unpack(reader, team.ranks(), policies)); });
    case Letter::kNothing:
      return std::nullopt;
    case Letter::kError:
      break;
  }
  raise(Failure::read(reader));
}

}  // namespace driftmesh::job
