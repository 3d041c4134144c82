#include "distributed/parts_file.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string_view>
#include <system_error>

#include "base/atomic_file.hpp"
#include "base/formatted.hpp"
#include "driftmesh/error.hpp"
#include "migration/packed_bytes.hpp"

namespace driftmesh {
namespace {

// For each part the end of its bytes among those of all, and these.
constexpr const char* kEnds = "ends";
constexpr const char* kParts = "subdomains";

Bytes sealed(const Bytes& bytes) {
  SealedBytes all(bytes.size());
  all.append(bytes.data(), bytes.size());
  return all.take();
}

/// The end of each part, on all ranks.
std::vector<std::uint64_t> ends_of(std::size_t count, const std::map<SubdomainId, std::uint64_t>& own, Ranks& ranks) {
  ByteWriter writer;
  for (const auto& [s, size] : own) {
    writer.value(s);
    writer.value(size + sizeof(PackedHeader));
  }
  std::vector<std::uint64_t> ends(count, 0);
  for (const Bytes& bytes : ranks.bytes_of_all(writer.take()))
    for (ByteReader reader(bytes); !reader.at_end();) {
      const auto s = reader.value<SubdomainId>();
      reader.value(ends.at(to_index(s)));
    }
  std::uint64_t end = 0;
  for (std::uint64_t& size : ends) size = end += size;
  return ends;
}

/// A file that is made under another name meanwhile.
struct Begun {
  std::unique_ptr<AtomicFile> file;
  std::uint64_t parts = 0;  ///< where their bytes begin
};

Begun begin(const std::string& path, const PartsFormat& format, const std::map<std::string, Bytes>& heads,
            const std::vector<std::uint64_t>& ends) {
  std::map<std::string, Bytes> arrays;
  for (const auto& [name, bytes] : heads) arrays[name] = sealed(bytes);
  ByteWriter places_of_ends;
  for (const std::uint64_t one : ends) places_of_ends.number(one);
  arrays[kEnds] = places_of_ends.take();
  std::map<std::string, std::uint64_t> sizes{{kParts, ends.empty() ? 0 : ends.back()}};
  for (const auto& [name, bytes] : arrays) sizes[name] = bytes.size();
  Begun begun{std::make_unique<AtomicFile>(path)};
  const std::string& name = begun.file->name_meanwhile();
  const Hdf5Places places = create_hdf5_bytes(name, path, format.version, sizes);
  for (const auto& [array, bytes] : arrays) write_hdf5_bytes(name, path, places.at(array), bytes);
  begun.parts = places.at(kParts);
  return begun;
}

void require_format(const Hdf5Bytes& file, const PartsFormat& format, const std::string& path) {
  for (const PartsFormat& other : {kAdaptiveMeshFile, kCheckpointFile})
    if (!file.has(format.head) && file.has(other.head))
      throw InputError({path, 0}, formatted("is {}, not {}", other.what, format.what), other.use);
  if (file.is_mesh())
    throw InputError({path, 0}, formatted("is a mesh alone, not {}", format.what),
                     formatted("give a file that {} wrote", format.source));
  if (file.version() != format.version)
    throw InputError({path, 0},
                     formatted("is {} of version {}, but this driftmesh reads version {}", format.what, file.version(),
                               format.version),
                     "use the driftmesh that wrote it");
}

}  // namespace

std::uint64_t write_parts(const std::string& path, const PartsFormat& format, const std::map<std::string, Bytes>& heads,
                          std::size_t count, const std::map<SubdomainId, std::uint64_t>& own,
                          const std::function<Bytes(SubdomainId)>& part, Ranks& ranks) {
  const std::vector<std::uint64_t> ends = ends_of(count, own, ranks);
  Begun begun;  // only on rank 0
  ByteWriter made;
  ranks.agree([&] {
    if (ranks.rank() != Rank{0}) return;
    begun = begin(path, format, heads, ends);
    made.text(begun.file->name_meanwhile());
    made.value(begun.parts);
  });
  const Bytes from_first = ranks.bytes_of_all(made.take()).front();
  ByteReader reader(from_first);
  const std::string name = reader.text();
  const auto first = reader.value<std::uint64_t>();
  ranks.agree([&] {
    for (const auto& [s, size] : own) {
      const Bytes bytes = part(s);
      if (bytes.size() != size) throw Error("subdomain " + to_string(s) + " changes while it is saved");
      const Bytes seal = sealed(bytes);
      write_hdf5_bytes(name, path, first + ends[to_index(s)] - seal.size(), seal);
    }
  });
  ranks.agree([&] {
    if (begun.file) begun.file->commit();
  });
  return ends.empty() ? 0 : ends.back();
}

PartsFile::PartsFile(std::string path, const PartsFormat& format) : path_(std::move(path)), file_(path_) {
  require_format(file_, format, path_);
  const Bytes bytes = file_.read(kEnds, 0, file_.size_of(kEnds));
  understand([&] {
    for (ByteReader reader(bytes); !reader.at_end();) ends_.push_back(reader.number<std::uint64_t>());
  });
  if (!std::ranges::is_sorted(ends_) || (!ends_.empty() && ends_.back() != file_.size_of(kParts)))
    throw InputError({path_, 0}, "has subdomains whose places do not fit their bytes", "was it written completely?");
}

Bytes PartsFile::head(const std::string& name) const {
  return unsealed(name, 0, file_.size_of(name), "its array " + name);
}

Bytes PartsFile::part(SubdomainId s) const {
  const std::size_t i = to_index(s);
  const std::uint64_t begin = i == 0 ? 0 : ends_[i - 1];
  return unsealed(kParts, begin, ends_[i] - begin, "subdomain " + to_string(s));
}

Bytes PartsFile::unsealed(const std::string& array, std::uint64_t first, std::uint64_t count,
                          const std::string& what) const {
  const Bytes bytes = file_.read(array, first, count);
  return understand([&] {
    SealReader reader(bytes, what);
    Bytes content(reader.left());
    (void)reader.read(content.data(), content.size());
    reader.verify();
    return content;
  });
}

void PartsFile::refuse(const Error& error) const {
  throw InputError({path_, 0}, std::string("cannot be loaded: ") + error.what(), "save it again");
}

bool is_parts_file(const std::string& path, const PartsFormat& format) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) return false;
  constexpr std::string_view kBegins = "\x89HDF\r\n\x1a\n";
  std::string begin(kBegins.size(), '\0');
  std::ifstream(path, std::ios::binary).read(begin.data(), static_cast<std::streamsize>(begin.size()));
  if (begin != kBegins) return false;
  try {
    return Hdf5Bytes(path).has(format.head);
  } catch (const InputError&) {
    return false;
  }
}

std::vector<std::size_t> shares_of(const std::vector<std::uint64_t>& ends, std::int32_t ranks) {
  const std::uint64_t all = ends.empty() ? 0 : ends.back();
  std::vector<std::size_t> firsts{0};
  for (std::int32_t rank = 1; rank < ranks; ++rank) {
    const double weight = static_cast<double>(all) * rank / ranks;
    const auto begins_at = [&](std::uint64_t end) { return static_cast<double>(end) <= weight; };
    firsts.push_back(static_cast<std::size_t>(std::ranges::partition_point(ends, begins_at) - ends.begin()));
  }
  firsts.push_back(ends.size());
  return firsts;
}

}  // namespace driftmesh
