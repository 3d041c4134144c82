#include "runtime/plan_bytes.hpp"

#include <algorithm>
#include <utility>

#include "base/bytes.hpp"
#include "base/narrow.hpp"
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
  stream.value(plan.bounds.plain);
  stream.array(plan.bounds.region_max_area);
  stream.value(plan.presplit);
  stream.value(plan.work);
  stream.value(plan.max_triangles);
  stream.value(plan.balancing.options);
}

/// Polygons in plain numbers: of each its number of rings, its region and its feature, then the length of each ring,
/// then all corners.
struct PackedPolygons {
  std::vector<std::int32_t> heads, lengths, corners;

  template <class Stream>
  void transfer(Stream& stream) {
    stream.array(heads);
    stream.array(lengths);
    stream.array(corners);
  }
};

void transfer_polygons(ByteWriter& writer, const std::vector<Pslg::Polygon>& polygons) {
  PackedPolygons packed;
  for (const Pslg::Polygon& polygon : polygons) {
    for (const std::int32_t value :
         {narrow<std::int32_t>(polygon.rings.size(), "rings"), polygon.region, polygon.feature})
      packed.heads.push_back(value);
    for (const Pslg::Ring& ring : polygon.rings) {
      packed.lengths.push_back(narrow<std::int32_t>(ring.size(), "corners of a ring"));
      packed.corners.insert(packed.corners.end(), ring.begin(), ring.end());
    }
  }
  packed.transfer(writer);
}

void transfer_polygons(ByteReader& reader, std::vector<Pslg::Polygon>& polygons) {
  PackedPolygons packed;
  packed.transfer(reader);
  std::size_t length = 0, corner = 0;
  for (std::size_t i = 0; i + 3 <= packed.heads.size(); i += 3) {
    Pslg::Polygon& polygon = polygons.emplace_back();
    polygon.region = packed.heads[i + 1];
    polygon.feature = packed.heads[i + 2];
    for (std::int32_t ring = 0; ring < packed.heads[i]; ++ring) {
      if (length == packed.lengths.size()) throw Error("its polygons are incomplete");
      const auto count = to_index(packed.lengths[length++]);
      if (count > packed.corners.size() - corner) throw Error("its polygons are incomplete");
      const auto first = packed.corners.begin() + static_cast<std::ptrdiff_t>(corner);
      polygon.rings.emplace_back(first, first + static_cast<std::ptrdiff_t>(count));
      corner += count;
    }
  }
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
  transfer_polygons(stream, pslg.polygons);
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

Bytes plan_for_file(RunPlan plan) {
  plan.balancing.policy = "none";
  plan.balancing.parameters.clear();
  std::ranges::fill(plan.owners, Rank{0});
  return plan_to_bytes(plan);
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
