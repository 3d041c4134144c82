#include "migration/packed_bytes.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

#include "base/error.hpp"

namespace driftmesh {
namespace {

constexpr std::uint64_t mix(std::uint64_t z) {  // of splitmix64
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9U;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBU;
  return z ^ (z >> 31);
}

}  // namespace

inline void Checksum::add(const Words& words, Words& sum, Words& sum_of_sums) {
  for (std::size_t k = 0; k < kLanes; ++k) {
    sum[k] += words[k];
    sum_of_sums[k] += sum[k];
  }
}

void Checksum::catch_up(std::span<const std::byte> bytes) {
  Words words, sum = sum_, sum_of_sums = sum_of_sums_;
  std::size_t i = taken_in_;
  for (; i + sizeof words <= bytes.size(); i += sizeof words) {
    std::memcpy(words.data(), bytes.data() + i, sizeof words);
    add(words, sum, sum_of_sums);
  }
  taken_in_ = i;
  sum_ = sum;
  sum_of_sums_ = sum_of_sums;
}

std::uint64_t Checksum::of(std::span<const std::byte> bytes) {
  catch_up(bytes);
  Words last{}, sum = sum_, sum_of_sums = sum_of_sums_;
  if (taken_in_ < bytes.size()) std::memcpy(last.data(), bytes.data() + taken_in_, bytes.size() - taken_in_);
  add(last, sum, sum_of_sums);
  std::uint64_t result = bytes.size();
  for (std::size_t k = 0; k < kLanes; ++k) result = mix(mix(result + sum[k]) + sum_of_sums[k]);
  return result;
}

SealedBytes::SealedBytes(std::size_t capacity) {
  bytes_.reserve(sizeof(PackedHeader) + capacity);
  bytes_.resize(sizeof(PackedHeader));
}

std::span<const std::byte> SealedBytes::payload() const {
  return std::span<const std::byte>(bytes_).subspan(sizeof(PackedHeader));
}

void SealedBytes::append(const void* data, std::size_t size) {
  constexpr std::size_t kInCache = 8192;
  const auto* next = static_cast<const std::byte*>(data);
  for (std::size_t left = size; left > 0;) {
    const std::size_t some = std::min(left, kInCache);
    bytes_.insert(bytes_.end(), next, next + some);
    checksum_.catch_up(payload());
    next += some;
    left -= some;
  }
}

protocol::Bytes SealedBytes::take() {
  PackedHeader header;
  header.length = payload().size();
  header.checksum = checksum_.of(payload());
  std::memcpy(bytes_.data(), &header, sizeof header);
  return std::move(bytes_);
}

std::span<const std::byte> open_sealed(std::span<const std::byte> bytes, const std::string& what) {
  PackedHeader header;
  if (bytes.size() < sizeof header) throw Error(what + " is too short to be one");
  std::memcpy(&header, bytes.data(), sizeof header);
  if (header.magic != PackedHeader::kMagic)
    throw Error(what + " does not begin like one; it must come from this program, on a machine of the same byte order");
  if (header.version != PackedHeader::kVersion)
    throw Error(what + " has version " + std::to_string(header.version) + ", but this program reads version " +
                std::to_string(PackedHeader::kVersion) + "; use the program that wrote it");
  const auto payload = bytes.subspan(sizeof header);
  if (header.length != payload.size() || header.reserved != 0)
    throw Error(what + " has " + std::to_string(payload.size()) + " bytes instead of " + std::to_string(header.length) +
                ": it was cut off or damaged on its way");
  if (header.checksum != Checksum().of(payload)) throw Error(what + " was damaged on its way: its checksum is wrong");
  return payload;
}

}  // namespace driftmesh
