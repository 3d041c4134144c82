#include "job/order.hpp"

#include <exception>
#include <string>
#include <utility>

#include "base/bytes.hpp"
#include "base/failure.hpp"
#include "job/domain.hpp"
#include "job/failure.hpp"
#include "runtime/plan_bytes.hpp"

namespace driftmesh::job {
namespace {

enum class Letter : std::uint8_t { kOrder, kError };

// The fields other than plan and input, in the same order for writing and reading.
template <class Stream, class Fields>
void transfer_rest(Stream& stream, Fields& order) {
  stream.value(order.sizing.across);
  stream.value(order.sizing.gradation);
  stream.value(order.sizing.shortest);
  stream.value(order.sizing.longest);
  stream.value(order.sizing.resolution);
  stream.value(order.sizing.courant_step);
  stream.value(order.sizing.courant);
  stream.value(order.sizing.courant_speed);
  stream.value(order.sizing.courant_length);
  stream.value(order.limits);
  stream.value(order.patience);
  stream.array(order.shares);
  stream.value(order.use);
}

/// Everything but plan and input, which are large and follow by themselves.
Bytes head_of(const Order& order) {
  ByteWriter writer;
  writer.value(Letter::kOrder);
  writer.text(order.sizing.expression);
  writer.text(order.sizing.background);
  writer.text(order.sizing.tree);
  transfer_rest(writer, order);
  writer.text(order.scratch);
  writer.text(order.keeping.checkpoint);
  writer.value(order.keeping.every);
  writer.text(order.keeping.resume);
  order.rasters.write(writer);
  return writer.take();
}

Order order_from(ByteReader& head) {
  Order order;
  order.sizing.expression = head.text();
  order.sizing.background = head.text();
  order.sizing.tree = head.text();
  transfer_rest(head, order);
  order.scratch = head.text();
  order.keeping.checkpoint = head.text();
  head.value(order.keeping.every);
  order.keeping.resume = head.text();
  order.rasters = Rasters::read(head);
  return order;
}

Bytes error(const Failure& failure) {
  ByteWriter writer;
  writer.value(Letter::kError);
  failure.write(writer);
  return writer.take();
}

/// The order that rank 0 makes. If that fails, it broadcasts the error before it throws.
Order made_by(const std::function<Order()>& make, Team& team) {
  try {
    return make();
  } catch (const std::exception&) {
    static_cast<void>(team.broadcast(error(failure_of(std::current_exception()))));
    throw;
  }
}

/// Rank 0 keeps its order as it is: a plan in many subdomains is large.
Order give(Team& team, const std::function<Order()>& make) {
  Order order = made_by(make, team);
  by_itself(team, [&] {
    static_cast<void>(team.broadcast(head_of(order)));
    static_cast<void>(team.broadcast(plan_to_bytes(order.plan)));
    static_cast<void>(team.broadcast(pslg_to_bytes(order.pslg)));
  });
  agree_on_failure(team, nullptr);
  return order;
}

Order taken(Team& team, ByteReader& head, const balancer::PolicyMaker& policies) {
  Order order = by_itself(team, [&] { return order_from(head); });
  const Bytes plan = team.broadcast({}), pslg = team.broadcast({});
  agree(team, [&] {
    order.plan = plan_from_bytes(plan, team.ranks(), policies);
    order.pslg = pslg_from_bytes(pslg);
    open_all(order.rasters, box_of(order.pslg), {});
    order.step = step_of(order.sizing, order.rasters);
  });
  return order;
}

Order take(Team& team, const balancer::PolicyMaker& policies) {
  const Bytes bytes = team.broadcast({});
  ByteReader head(bytes);
  if (head.value<Letter>() == Letter::kError) raise(Failure::read(head));
  return taken(team, head, policies);
}

}  // namespace

Order share(Team& team, const std::function<Order()>& make, const balancer::PolicyMaker& policies) {
  return team.leads() ? give(team, make) : take(team, policies);
}

}  // namespace driftmesh::job
