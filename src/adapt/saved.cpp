#include "adapt/saved.hpp"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "distributed/parts_file.hpp"
#include "driftmesh/error.hpp"
#include "runtime/plan_bytes.hpp"

namespace driftmesh::adapt {
namespace {

/// Sizes of what is stored as it is in memory: other machines, and other programs, may have others.
std::array<std::uint64_t, 6> layout_of_memory() {
  return {sizeof(Decomposition::Root), sizeof(Decomposition::Subdomain),    sizeof(PlainBounds),
          sizeof(WorkSettings),        sizeof(balancer::ControllerOptions), sizeof(AdaptiveOptions)};
}

Bytes bytes_of(const SavedHead& head) {
  ByteWriter writer;
  writer.value(layout_of_memory());
  writer.value(head.options);
  writer.value(head.generation);
  writer.value(head.shares);
  writer.value(std::uint64_t{head.fields.size()});
  for (const auto& [name, field] : head.fields) {
    writer.text(name);
    writer.value(field.place);
    writer.value(field.how);
    writer.value(std::uint64_t{field.components});
  }
  writer.array(plan_for_file(head.plan));
  writer.array(pslg_to_bytes(head.pslg));
  writer.array(head.more);
  for (const auto& [name, shape] : head.shapes) {
    writer.text(name);
    writer.array(shape);
  }
  return writer.take();
}

SavedHead head_from(const Bytes& bytes) {
  SavedHead head;
  ByteReader reader(bytes);
  if (reader.value<decltype(layout_of_memory())>() != layout_of_memory())
    throw Error("it was saved by another build of driftmesh, or on another kind of machine");
  reader.value(head.options);
  reader.value(head.generation);
  reader.value(head.shares);
  if (head.shares < 1) throw Error("it does not say of how many subdomains one has the mean");
  for (auto left = reader.value<std::uint64_t>(); left > 0; --left) {
    Field& field = head.fields[reader.text()];
    reader.value(field.place);
    reader.value(field.how);
    field.components = static_cast<std::size_t>(reader.value<std::uint64_t>());
  }
  Bytes plan, pslg;
  reader.array(plan);
  reader.array(pslg);
  reader.array(head.more);
  while (!reader.at_end()) {  // files of older programs have no shapes
    const std::string name = reader.text();
    const auto field = head.fields.find(name);
    if (field == head.fields.end()) throw Error("it has a shape of a field '" + name + "' that it does not have");
    reader.array(head.shapes[name]);
    require_shape(name, head.shapes[name], field->second.components);
  }
  head.plan = plan_from_bytes(plan, 1);
  head.pslg = pslg_from_bytes(pslg);
  return head;
}

Saved read_own(const std::string& path, const Ranks& ranks) {
  const PartsFile file(path, kAdaptiveMeshFile);
  return file.understand([&] {
    Saved saved;
    saved.head = head_from(file.head(kAdaptiveMeshFile.head));
    if (file.ends().size() != saved.head.plan.decomposition.size()) throw Error("it has another number of subdomains");
    const std::vector<std::size_t> firsts = shares_of(file.ends(), ranks.ranks());
    const std::size_t own = to_index(ranks.rank());
    for (std::size_t i = firsts[own]; i < firsts[own + 1]; ++i) {
      const auto s = static_cast<SubdomainId>(i);
      Parcel parcel = unpack_parcel(file.part(s), Source::kUnknown);
      if (parcel.id != s) throw Error("subdomain " + to_string(s) + " is another one");
      saved.parcels.emplace(s, std::move(parcel));
    }
    return saved;
  });
}

}  // namespace

void save(const std::string& path, const SavedHead& head, const Packing& packing, Ranks& ranks) {
  std::map<std::string, Bytes> heads;
  std::map<SubdomainId, std::uint64_t> sizes;
  ranks.agree([&] {
    if (ranks.rank() == Rank{0}) heads[kAdaptiveMeshFile.head] = bytes_of(head);
    for (const SubdomainId s : packing.here) sizes[s] = packing.size(s);
  });
  write_parts(path, kAdaptiveMeshFile, heads, head.plan.decomposition.size(), sizes, packing.pack, ranks);
}

Saved read_saved(const std::string& path, Ranks& ranks) {
  Saved saved;
  ranks.agree([&] {
    if (path.empty()) throw Error("load: the name of the file is empty; give that of a file that save() wrote");
    saved = read_own(path, ranks);
  });
  return saved;
}

}  // namespace driftmesh::adapt
