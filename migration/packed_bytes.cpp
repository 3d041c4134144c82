#include "migration/packed_bytes.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

#include "base/mix.hpp"
#include "driftmesh/error.hpp"

namespace driftmesh {
namespace {

/// Two lanes in a register that every x86-64 and AArch64 has (gcc's and clang's extension). With wider vectors, or
/// arrays of words, compilers put the sums into memory between the additions, at half the speed.
using Pair [[gnu::vector_size(16)]] = std::uint64_t;

template <class From>
Pair load(const From* from) {
  Pair pair;
  std::memcpy(&pair, from, sizeof pair);
  return pair;
}

/// Bytes copied before they are summed up, so that they are still in the cache.
constexpr std::size_t kInCache = 65536;

}  // namespace

void Checksum::catch_up(std::span<const std::byte> bytes) {
  Pair a = load(&sum_[0]), b = load(&sum_[2]), c = load(&sum_[4]), d = load(&sum_[6]);
  Pair aa = load(&sum_of_sums_[0]), bb = load(&sum_of_sums_[2]), cc = load(&sum_of_sums_[4]),
       dd = load(&sum_of_sums_[6]);
  std::size_t i = taken_in_;
  for (; i + sizeof(Words) <= bytes.size(); i += sizeof(Words)) {
    const std::byte* const block = bytes.data() + i;
    aa += a += load(block);
    bb += b += load(block + 16);
    cc += c += load(block + 32);
    dd += d += load(block + 48);
  }
  taken_in_ = i;
  const Pair sums[] = {a, b, c, d}, sums_of_sums[] = {aa, bb, cc, dd};
  std::memcpy(sum_.data(), sums, sizeof sums);
  std::memcpy(sum_of_sums_.data(), sums_of_sums, sizeof sums_of_sums);
}

std::uint64_t Checksum::of(std::span<const std::byte> bytes) {
  catch_up(bytes);
  Words last{};
  if (taken_in_ < bytes.size()) std::memcpy(last.data(), bytes.data() + taken_in_, bytes.size() - taken_in_);
  std::uint64_t result = bytes.size();
  for (std::size_t k = 0; k < kLanes; ++k)
    result = mix(mix(result + sum_[k] + last[k]) + sum_of_sums_[k] + sum_[k] + last[k]);
  return result;
}

SealedBytes::SealedBytes(std::size_t capacity) {
  bytes_.reserve(sizeof(PackedHeader) + capacity);
  bytes_.resize(sizeof(PackedHeader));
}

std::span<const std::byte> SealedBytes::payload() const {
  return std::span<const std::byte>(bytes_).subspan(sizeof(PackedHeader));
}

SealedBytes SealedBytes::counted() {
  SealedBytes none(0);
  none.counted_ = sizeof(PackedHeader);
  return none;
}

void SealedBytes::append(const void* data, std::size_t size) {
  if (counted_ > 0) {
    counted_ += size;
    return;
  }
  const auto* next = static_cast<const std::byte*>(data);
  for (std::size_t left = size; left > 0;) {
    const std::size_t some = std::min(left, kInCache);
    bytes_.insert(bytes_.end(), next, next + some);
    checksum_.catch_up(payload());
    next += some;
    left -= some;
  }
}

Bytes SealedBytes::take() {
  PackedHeader header;
  header.length = payload().size();
  header.checksum = checksum_.of(payload());
  std::memcpy(bytes_.data(), &header, sizeof header);
  return std::move(bytes_);
}

SealReader::SealReader(std::span<const std::byte> bytes, std::string what) : what_(std::move(what)) {
  PackedHeader header;
  if (bytes.size() < sizeof header) throw Error(what_ + " is too short to be one");
  std::memcpy(&header, bytes.data(), sizeof header);
  if (header.magic != PackedHeader::kMagic)
    throw Error(what_ + " has no valid header; it must come from this program, on a machine of the same byte order");
  if (header.version != PackedHeader::kVersion)
    throw Error(what_ + " has version " + std::to_string(header.version) + ", but this program reads version " +
                std::to_string(PackedHeader::kVersion) + "; use the program that wrote it");
  payload_ = bytes.subspan(sizeof header);
  if (header.length != payload_.size() || header.reserved != 0)
    throw Error(what_ + " has " + std::to_string(payload_.size()) + " bytes instead of " +
                std::to_string(header.length) + ": it was truncated or damaged in transit");
  expected_ = header.checksum;
}

std::size_t SealReader::read(void* to, std::size_t size) {
  size = std::min(size, left());
  auto* next = static_cast<std::byte*>(to);
  for (std::size_t rest = size; rest > 0;) {
    const std::size_t some = std::min(rest, kInCache);
    std::memcpy(next, payload_.data() + read_, some);
    read_ += some;
    checksum_.catch_up(payload_.first(read_));
    next += some;
    rest -= some;
  }
  return size;
}

void SealReader::verify() {
  if (checksum_.of(payload_) != expected_) throw Error(what_ + " was damaged in transit: its checksum is wrong");
}

}  // namespace driftmesh
