#include "runtime/plan_bytes.hpp"

#include <utility>

#include "base/bytes.hpp"
#include "driftmesh/error.hpp"
#include "pslg/names.hpp"
#include "runtime/plan_run.hpp"

namespace driftmesh {
namespace {

// The fields in one order for both directions: `stream` is a ByteWriter with a const value, or a ByteReader.

template <class Stream, class Plan>
void transfer_plan(Stream& stream, Plan& plan) {
  auto& d = plan.decomposition;
  stream.array(d.points);
  stream.array(d.origin);
  stream.array(d.roots);
  stream.array(d.subdomains);
  stream.array(d.point_begin);
  stream.array(d.point_list);
  stream.array(plan.owners);
  stream.value(plan.bounds.min_angle);
  stream.value(plan.bounds.max_area);
  stream.array(plan.bounds.region_max_area);
  stream.value(plan.presplit);
  stream.value(plan.work);
  stream.value(plan.max_triangles);
  stream.value(plan.balancing.options);
}

template <class Stream, class Input>
void transfer_pslg(Stream& stream, Input& pslg) {
  stream.array(pslg.points);
  stream.array(pslg.point_markers);
  stream.array(pslg.attributes);
  stream.value(pslg.attributes_per_point);
  stream.array(pslg.segments);
  stream.array(pslg.holes);
  stream.array(pslg.regions);
  stream.value(pslg.first_number);
  transfer_names(stream, pslg.names);
}

/// About the size of the arrays that grow with the number of subdomains.
std::size_t array_bytes(const RunPlan& plan) {
  const Decomposition& d = plan.decomposition;
  return d.points.size() * (sizeof(Point) + sizeof(VertexOrigin)) + d.roots.size() * sizeof(Decomposition::Root) +
         d.size() * (sizeof(Decomposition::Subdomain) + sizeof(Rank) + sizeof(std::int32_t));
}

/// Lets `read(ByteReader&)` read everything that another rank has written.
template <class Read>
void read_all(const char* what, std::span<const std::byte> bytes, const Read& read) {
  try {
    ByteReader reader(bytes);
    read(reader);
    reader.end();
  } catch (const Error& error) {
    throw Error(std::string(what) + " from another rank cannot be read, " + error.what() +
                "; start the same build on every rank");
  }
}

}  // namespace

Bytes pslg_to_bytes(const Pslg& pslg) {
  ByteWriter writer;
  transfer_pslg(writer, pslg);
  return writer.take();
}

Pslg pslg_from_bytes(std::span<const std::byte> bytes) {
  Pslg pslg;
  read_all("the input", bytes, [&](ByteReader& reader) { transfer_pslg(reader, pslg); });
  return pslg;
}

Bytes plan_to_bytes(const RunPlan& plan) {
  ByteWriter writer;
  writer.reserve(array_bytes(plan) + (std::size_t{1} << 12));
  transfer_plan(writer, plan);
  writer.text(plan.balancing.policy);
  writer.value(static_cast<std::uint64_t>(plan.balancing.parameters.size()));
  for (const auto& [name, value] : plan.balancing.parameters) {
    writer.text(name);
    writer.text(value);
  }
  return writer.take();
}

RunPlan plan_from_bytes(std::span<const std::byte> bytes, std::int32_t ranks, const balancer::PolicyMaker& policies) {
  RunPlan plan;
  read_all("the plan", bytes, [&](ByteReader& reader) {
    transfer_plan(reader, plan);
    list_roots(plan.decomposition);
    plan.balancing.policy = reader.text();
    for (auto left = reader.value<std::uint64_t>(); left > 0; --left) {
      const std::string name = reader.text();
      plan.balancing.parameters[name] = reader.text();
    }
  });
  prepare_balancing(plan, ranks, policies);
  return plan;
}

}  // namespace driftmesh
