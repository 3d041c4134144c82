#include "adapt/saved.hpp"

#include <algorithm>
#include <array>
#include <memory>
#include <utility>

#include "adapt/of_all_parts.hpp"
#include "base/atomic_file.hpp"
#include "base/formatted.hpp"
#include "driftmesh/error.hpp"
#include "io/hdf5_bytes.hpp"
#include "migration/packed_bytes.hpp"
#include "runtime/plan_bytes.hpp"

namespace driftmesh::adapt {
namespace {

constexpr std::int64_t kVersion = 1;

// Arrays of the file: the head; for each part the end of its bytes among those of all; these.
constexpr const char* kHead = "session";
constexpr const char* kEnds = "ends";
constexpr const char* kParts = "subdomains";

/// Sizes of what is stored as it is in memory: other machines, and other programs, may have others.
std::array<std::uint64_t, 6> layout_of_memory() {
  return {sizeof(Decomposition::Root), sizeof(Decomposition::Subdomain),    sizeof(PlainBounds),
          sizeof(WorkSettings),        sizeof(balancer::ControllerOptions), sizeof(AdaptiveOptions)};
}

Bytes sealed(const Bytes& bytes) {
  SealedBytes all(bytes.size());
  all.append(bytes.data(), bytes.size());
  return all.take();
}

Bytes unsealed(const Bytes& bytes, const std::string& what) {
  SealReader reader(bytes, what);
  Bytes content(reader.left());
  (void)reader.read(content.data(), content.size());
  reader.verify();
  return content;
}

Bytes bytes_of(const SavedHead& head) {
  RunPlan plan = head.plan;
  plan.balancing.policy = "none";
  plan.balancing.parameters.clear();
  std::ranges::fill(plan.owners, Rank{0});
  ByteWriter writer;
  writer.value(layout_of_memory());
  writer.value(head.options);
  writer.value(head.generation);
  writer.value(std::uint64_t{head.fields.size()});
  for (const auto& [name, field] : head.fields) {
    writer.text(name);
    writer.value(field.place);
    writer.value(field.how);
    writer.value(std::uint64_t{field.components});
  }
  writer.array(plan_to_bytes(plan));
  writer.array(pslg_to_bytes(head.pslg));
  writer.array(head.more);
  return sealed(writer.take());
}

SavedHead head_from(const Bytes& bytes) {
  SavedHead head;
  ByteReader reader(bytes);
  if (reader.value<decltype(layout_of_memory())>() != layout_of_memory())
    throw Error("it was saved by another build of driftmesh, or on another kind of machine");
  reader.value(head.options);
  reader.value(head.generation);
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
  reader.end();
  head.plan = plan_from_bytes(plan, 1);
  head.pslg = pslg_from_bytes(pslg);
  return head;
}

/// The first and the last part that this rank takes, so that all take about as many bytes.
std::pair<std::size_t, std::size_t> share_of(const std::vector<std::uint64_t>& ends, const Ranks& ranks) {
  const std::uint64_t all = ends.empty() ? 0 : ends.back();
  const auto first_of = [&](std::int32_t rank) {
    const double bytes = static_cast<double>(all) * rank / ranks.ranks();
    const auto begins_at = [&](std::uint64_t end) { return static_cast<double>(end) <= bytes; };
    return rank == ranks.ranks() ? ends.size()
           : rank == 0           ? 0
                       : static_cast<std::size_t>(std::ranges::partition_point(ends, begins_at) - ends.begin());
  };
  const std::int32_t own = to_int(ranks.rank());
  return {first_of(own), first_of(own + 1)};
}

void require_known(std::int64_t version, const std::string& path) {
  if (version != kVersion)
    throw InputError(
        {path, 0},
        formatted("is an adaptive mesh of version {}, but this driftmesh reads version {}", version, kVersion),
        "load it with the driftmesh that saved it");
}

std::vector<std::uint64_t> read_ends(const Hdf5Bytes& file, const std::string& path) {
  const Bytes bytes = file.read(kEnds, 0, file.size_of(kEnds));
  std::vector<std::uint64_t> ends;
  for (ByteReader reader(bytes); !reader.at_end();) ends.push_back(reader.number<std::uint64_t>());
  if (!std::ranges::is_sorted(ends) || (!ends.empty() && ends.back() != file.size_of(kParts)))
    throw InputError({path, 0}, "has subdomains whose places do not fit their bytes", "was it written completely?");
  return ends;
}

Saved read_own(const std::string& path, const Ranks& ranks) {
  const Hdf5Bytes file(path);
  require_known(file.version(), path);
  Saved saved;
  try {
    saved.head = head_from(unsealed(file.read(kHead, 0, file.size_of(kHead)), "its head"));
    const std::vector<std::uint64_t> ends = read_ends(file, path);
    if (ends.size() != saved.head.plan.decomposition.size()) throw Error("it has another number of subdomains");
    const auto [first, last] = share_of(ends, ranks);
    for (std::size_t i = first; i < last; ++i) {
      const std::uint64_t begin = i == 0 ? 0 : ends[i - 1];
      const std::string what = "subdomain " + std::to_string(i);
      Parcel parcel = unpack_parcel(unsealed(file.read(kParts, begin, ends[i] - begin), what), Source::kUnknown);
      const auto s = static_cast<SubdomainId>(i);
      if (parcel.id != s) throw Error(what + " is another one");
      saved.parcels.emplace(s, std::move(parcel));
    }
  } catch (const InputError&) {
    throw;
  } catch (const FileError&) {
    throw;
  } catch (const Error& error) {
    throw InputError({path, 0}, std::string("cannot be loaded: ") + error.what(), "save it again");
  }
  return saved;
}

}  // namespace

void save(const std::string& path, const SavedHead& head, const Generation& generation, const Fields& fields,
          Ranks& ranks) {
  std::map<SubdomainId, Bytes> own;
  ranks.agree([&] {
    for (const SubdomainId s : generation.here) own[s] = sealed(pack(generation, s, fields));
  });
  IdVector<SubdomainId, std::uint64_t> ends =
      of_all_parts(ranks, generation, [&](SubdomainId s) { return std::uint64_t{own.at(s).size()}; });
  std::uint64_t end = 0;
  for (std::uint64_t& size : ends) size = end += size;

  std::unique_ptr<AtomicFile> file;  // only on rank 0
  ByteWriter made;
  ranks.agree([&] {
    if (ranks.rank() != Rank{0}) return;
    ByteWriter places_of_ends;
    for (const std::uint64_t one : ends) places_of_ends.number(one);
    const Bytes first = bytes_of(head), second = places_of_ends.take();
    file = std::make_unique<AtomicFile>(path);
    const std::string& name = file->name_meanwhile();
    const Hdf5Places places =
        create_hdf5_bytes(name, path, kVersion, {{kHead, first.size()}, {kEnds, second.size()}, {kParts, end}});
    write_hdf5_bytes(name, path, places.at(kHead), first);
    write_hdf5_bytes(name, path, places.at(kEnds), second);
    made.text(name);
    made.value(places.at(kParts));
  });
  const Bytes from_first = ranks.bytes_of_all(made.take()).front();
  ByteReader reader(from_first);
  const std::string name = reader.text();
  const auto begin = reader.value<std::uint64_t>();
  ranks.agree([&] {
    for (const auto& [s, bytes] : own) write_hdf5_bytes(name, path, begin + ends[s] - bytes.size(), bytes);
  });
  ranks.agree([&] {
    if (file) file->commit();
  });
}

Saved read_saved(const std::string& path, Ranks& ranks) {
  Saved saved;
  ranks.agree([&] { saved = read_own(path, ranks); });
  return saved;
}

}  // namespace driftmesh::adapt
