#include "job/checkpoint_file.hpp"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>
#include <vector>

#include "base/key_error.hpp"
#include "distributed/parts_file.hpp"
#include "driftmesh/error.hpp"
#include "job/domain.hpp"
#include "job/keys.hpp"
#include "job/value_bytes.hpp"
#include "runtime/plan_bytes.hpp"

namespace driftmesh::job {
namespace {

constexpr const char* kSettings = "settings";

/// Whether the mesh is the same for each value of the key.
bool is_free(const std::string& name) {
  constexpr std::array<std::string_view, 11> kFree{"run.method",  "run.aggregation", "run.order", "run.slice",
                                                   "run.silence", "run.give-up",     "run.sleep", "run.scratch",
                                                   "run.threads", "run.checkpoint",  "run.every"};
  if (name == "output.depth") return false;  // values of points
  return name.starts_with("output.") || name.starts_with("limits.") || name == "run.resume" ||
         std::ranges::find(kFree, name) != kFree.end();
}

/// Sizes of what is stored as it is in memory: other machines, and other programs, may have others.
std::array<std::uint64_t, 5> layout_of_memory() {
  return {sizeof(Decomposition::Root), sizeof(Decomposition::Subdomain), sizeof(PlainBounds), sizeof(WorkSettings),
          sizeof(balancer::ControllerOptions)};
}

/// The lengths at some places, by which a file shows whether a size field is still the same.
std::vector<double> samples_of(const SizeField* size, const Decomposition& decomposition) {
  std::vector<double> lengths;
  if (size == nullptr) return lengths;
  constexpr std::size_t kMost = 2000;
  const std::size_t step = std::max<std::size_t>(1, decomposition.points.size() / kMost);
  std::size_t i = 0;
  for (const Point& p : decomposition.points)
    if (i++ % step == 0) lengths.push_back(size->edge_length(p));
  return lengths;
}

/// Gives each rank neighboring subdomains with about as much work left. `ends`: of their bytes in the file.
void deal(RunPlan& plan, const std::vector<std::uint64_t>& ends, std::int32_t ranks) {
  constexpr std::uint64_t kNotBegun = 400;  // bytes, at most
  constexpr double kBegun = 0.05;           // a part of the work: nearly all that have begun have also ended
  std::vector<std::uint64_t> work;
  std::uint64_t end = 0, sum = 0;
  for (std::size_t i = 0; i < ends.size(); ++i) {
    const bool begun = ends[i] - std::exchange(end, ends[i]) > kNotBegun;
    sum += 1 + static_cast<std::uint64_t>((begun ? kBegun : 1) *
                                          plan.decomposition.subdomains[static_cast<SubdomainId>(i)].predicted);
    work.push_back(sum);
  }
  const std::vector<std::size_t> firsts = shares_of(work, ranks);
  for (const Rank r : first_ids<Rank>(ranks))
    for (std::size_t i = firsts[to_index(r)]; i < firsts[to_index(r) + 1]; ++i)
      plan.owners[static_cast<SubdomainId>(i)] = r;
}

Bytes settings_bytes(const Request& request) {
  ByteWriter writer;
  for (const Key& key : keys()) {
    const Value value = key.load(request);
    if (is_free(key.name) || key.name == "sizing.save-tree" || value == key.standard) continue;
    writer.text(key.name);
    write_value(writer, value);
  }
  return writer.take();
}

Request request_in(const Bytes& bytes) {
  Request request;
  for (ByteReader reader(bytes); !reader.at_end();) {
    const std::string name = reader.text();
    const KeyPath path = find_key(name);
    const Value value = read_value(reader);
    if (path.key == nullptr || value.index() != path.key->standard.index())
      throw Error("it has a setting " + name + " that this driftmesh does not know");
    path.key->store(request, value);
  }
  return request;
}

}  // namespace

std::map<std::string, Bytes> checkpoint_heads(const Request& request, const RunRecord& record, const Order& order) {
  ByteWriter writer;
  writer.value(layout_of_memory());
  writer.value(record.acute_corners);
  writer.value(record.forecast);
  writer.text(order.rasters.projection);
  writer.value(static_cast<std::uint8_t>(order.rasters.from_lonlat ? 1 : 0));
  writer.array(samples_of(order.size.get(), order.plan.decomposition));
  writer.array(plan_for_file(order.plan));
  writer.array(pslg_to_bytes(order.pslg));
  return {{kSettings, settings_bytes(request)}, {kCheckpointFile.head, writer.take()}};
}

Request resumed_request(const Request& asked, const std::set<std::string>& given) {
  const std::string& path = asked.run.resume;
  const PartsFile file(path, kCheckpointFile);
  Request request = file.understand([&] { return request_in(file.head(kSettings)); });
  for (const Key& key : keys()) {
    const Value wanted = key.load(asked);
    if (is_free(key.name))
      key.store(request, wanted);
    else if (given.contains(key.name) && wanted != key.load(request))
      throw KeyError(key.name,
                     KeyText::of("is {}, but the run in {} has {}", text_of(wanted), path, text_of(key.load(request))),
                     "remove it: what decides the mesh comes from {run.resume}");
  }
  return request;
}

Order resumed_order(const Request& request, std::int32_t ranks, RunRecord& record) {
  const std::string& path = request.run.resume;
  const PartsFile file(path, kCheckpointFile);
  Domain domain;
  Order order;
  std::vector<double> samples;
  file.understand([&] {
    const Bytes head = file.head(kCheckpointFile.head);
    ByteReader reader(head);
    if (reader.value<decltype(layout_of_memory())>() != layout_of_memory())
      throw Error("it was written by another build of driftmesh, or on another kind of machine");
    reader.value(record.acute_corners);
    reader.value(record.forecast);
    domain.projection = reader.text();
    domain.from_lonlat = reader.value<std::uint8_t>() != 0;
    reader.array(samples);
    Bytes plan, pslg;
    reader.array(plan);
    reader.array(pslg);
    reader.end();
    order.plan = plan_from_bytes(plan, 1);
    domain.pslg = pslg_from_bytes(pslg);
    if (file.ends().size() != order.plan.decomposition.size()) throw Error("it has another number of subdomains");
    deal(order.plan, file.ends(), ranks);
  });
  record.max_area = order.plan.bounds.plain.area;
  record_domain(record, request, domain);
  order.pslg = std::move(domain.pslg);
  order.sizing = request.sizing;
  order.rasters = rasters_of(request, domain.projection, domain.from_lonlat);
  open_all(order.rasters, box_of(order.pslg), {});
  order.size = size_of(order.sizing, order.rasters.open, nullptr, order.pslg).field;
  order.step = step_of(order.sizing, order.rasters);
  if (samples_of(order.size.get(), order.plan.decomposition) != samples)
    throw InputError({path, 0}, "was written with other lengths than those that are asked for now",
                     "did a file that they come from change?");
  return order;
}

}  // namespace driftmesh::job
