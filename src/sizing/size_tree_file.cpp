#include "sizing/size_tree_file.hpp"

#include <bit>
#include <cstddef>
#include <string>
#include <string_view>

#include "base/atomic_file.hpp"
#include "base/bytes.hpp"
#include "base/file_bytes.hpp"
#include "base/key_error.hpp"
#include "base/mix.hpp"
#include "driftmesh/error.hpp"

namespace driftmesh {
namespace {

constexpr std::string_view kFirstLine = "driftmesh size tree\n";
constexpr std::uint64_t kTreeVersion = 1;

/// Of numbers in their order.
class RunningDigest {
 public:
  void add(std::uint64_t number) { value_ = mix(value_ * kMixStep + number); }
  void add(const Point& p) {
    add(std::bit_cast<std::uint64_t>(p.x + 0.0));  // -0 is 0
    add(std::bit_cast<std::uint64_t>(p.y + 0.0));
  }
  [[nodiscard]] std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 1;
};

std::uint64_t checksum(std::span<const std::byte> bytes) {
  RunningDigest digest;
  for (std::size_t i = 0; i < bytes.size(); i += 8) {
    std::uint64_t word = 0;
    for (std::size_t k = i; k < bytes.size() && k < i + 8; ++k)
      word |= std::to_integer<std::uint64_t>(bytes[k]) << (8 * (k - i));
    digest.add(word);
  }
  digest.add(bytes.size());
  return digest.value();
}

std::uint64_t number(ByteReader& reader) {
  return reader.number<std::uint64_t>();
}

}  // namespace

std::uint64_t domain_digest(const Pslg& pslg) {
  RunningDigest digest;
  digest.add(pslg.points.size());
  for (const Point& p : pslg.points) digest.add(p);
  digest.add(pslg.segments.size());
  for (const Pslg::Segment& s : pslg.segments) {
    digest.add(static_cast<std::uint64_t>(s.a));
    digest.add(static_cast<std::uint64_t>(s.b));
  }
  return digest.value();
}

void write_size_tree(const SizeTree& tree, std::span<const CornerPoints> domain, std::uint64_t digest,
                     const std::string& path) {
  ByteWriter packed, head;
  try {
    tree.pack(domain, packed);
  } catch (const InputError&) {
    throw;
  } catch (const Error& error) {
    throw Keyed<InputError>({path}, std::string("cannot be written: ") + error.what(),
                            "limit them from below with {sizing.min}, so that they are surely positive");
  }
  const Bytes bytes = packed.take();
  for (const std::uint64_t value : {kTreeVersion, digest, std::uint64_t{bytes.size()}, checksum(bytes)})
    head.number(value);
  AtomicFile file(path);
  file.write(kFirstLine);
  const Bytes numbers = head.take();
  file.write(numbers.data(), numbers.size());
  file.write(bytes.data(), bytes.size());
  file.commit();
}

std::unique_ptr<SizeTree> read_size_tree(const std::string& path, std::optional<std::uint64_t> digest) {
  const FileBytes file(path);
  const std::string_view text = file.view();
  if (!text.starts_with(kFirstLine))
    throw Keyed<InputError>({path}, "is no compiled size field", "name a file that {sizing.save-tree} made");
  const auto* const begin = reinterpret_cast<const std::byte*>(text.data());
  ByteReader reader({begin + kFirstLine.size(), text.size() - kFirstLine.size()});
  try {
    if (const std::uint64_t version = number(reader); version != kTreeVersion)
      throw Keyed<InputError>({path},
                              "has version " + std::to_string(version) + " of its format, this program reads " +
                                  std::to_string(kTreeVersion),
                              "make it anew with {sizing.save-tree}");
    const std::uint64_t domain = number(reader), size = number(reader), sum = number(reader);
    constexpr std::size_t kHead = kFirstLine.size() + 4 * sizeof(std::uint64_t);
    const std::span<const std::byte> bytes{begin + kHead, text.size() - kHead};
    if (bytes.size() != size || checksum(bytes) != sum)
      throw Keyed<InputError>({path}, "is damaged or incomplete", "make it anew with {sizing.save-tree}");
    if (digest && domain != *digest)
      throw Keyed<InputError>(
          {path}, "was compiled for another domain",
          "sizes are compiled for one domain, after its repair: make it anew with {sizing.save-tree}");
    return SizeTree::unpacked(reader);
  } catch (const InputError&) {
    throw;
  } catch (const Error&) {
    throw Keyed<InputError>({path}, "is damaged or incomplete", "make it anew with {sizing.save-tree}");
  }
}

}  // namespace driftmesh
