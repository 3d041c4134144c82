#include "runtime/plan_bytes.hpp"

#include "base/byte_stream.hpp"
#include "base/error.hpp"

namespace driftmesh {
namespace {

/// The fields in one order for both directions: `stream` is a ByteWriter with a const plan, or a ByteReader.
template <class Stream, class Plan>
void transfer(Stream& stream, Plan& plan) {
  auto& d = plan.decomposition;
  stream.array(d.points);
  stream.array(d.origin);
  stream.array(d.roots);
  stream.array(d.subdomains);
  stream.array(d.root_begin);
  stream.array(d.root_list);
  stream.array(d.point_begin);
  stream.array(d.point_list);
  stream.array(plan.owners);
  stream.value(plan.bounds.min_angle);
  stream.value(plan.bounds.max_area);
  stream.array(plan.bounds.region_max_area);
  stream.value(plan.presplit);
  stream.value(plan.aggregation);
  stream.value(plan.slice);
  stream.value(plan.order);
  stream.value(plan.max_triangles);
}

}  // namespace

protocol::Bytes plan_to_bytes(const RunPlan& plan) {
  ByteWriter writer;
  transfer(writer, plan);
  return writer.take();
}

RunPlan plan_from_bytes(std::span<const std::byte> bytes) {
  ByteReader reader(bytes);
  RunPlan plan;
  transfer(reader, plan);
  if (!reader.at_end()) throw Error("a plan from another rank is too long: are all of one version?");
  return plan;
}

}  // namespace driftmesh
