#include "migration/packed_bytes.hpp"

#include <doctest/doctest.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "driftmesh/error.hpp"
#include "support/error_text.hpp"

// Bytes under a header and a checksum: what a change of them must not pass.

using namespace driftmesh;

namespace {

/// Different words, so many blocks of eight.
std::vector<std::uint64_t> words_in_blocks(std::size_t blocks) {
  std::vector<std::uint64_t> words(8 * blocks);
  std::iota(words.begin(), words.end(), 1000);
  return words;
}

std::uint64_t checksum_of(const std::vector<std::uint64_t>& words) {
  return Checksum().of(std::as_bytes(std::span(words)));
}

Bytes sealed(const std::vector<std::uint64_t>& words) {
  SealedBytes out(8 * words.size());
  out.append(words.data(), 8 * words.size());
  return out.take();
}

}  // namespace

TEST_CASE("a checksum tells words that have changed places") {
  const std::vector<std::uint64_t> words = words_in_blocks(4);
  const std::uint64_t sum = checksum_of(words);
  for (std::size_t i = 0; i < words.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      std::vector<std::uint64_t> swapped = words;
      std::swap(swapped[i], swapped[j]);
      CHECK(checksum_of(swapped) != sum);
    }
}

TEST_CASE("a packed form of any other version is refused") {
  const Bytes bytes = sealed(words_in_blocks(2));
  const auto of_version = [&](std::uint32_t version) {
    Bytes other = bytes;
    std::memcpy(other.data() + offsetof(PackedHeader, version), &version, sizeof version);
    return testing::error_text<Error>([&] { SealReader(other, "the packed form"); });
  };
  CHECK(of_version(PackedHeader::kVersion) == "no error");
  for (const std::uint32_t version : {PackedHeader::kVersion - 1, PackedHeader::kVersion + 1})
    CHECK(of_version(version).starts_with("the packed form"));
}
