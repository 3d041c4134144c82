#pragma once

#include <bit>
#include <cstring>
#include <span>
#include <type_traits>
#include <vector>

#include "protocol/ids.hpp"
#include "protocol/protocol_error.hpp"

namespace driftmesh {

static_assert(std::endian::native == std::endian::little, "messages hold numbers in the machine's byte order");

/// Appends numbers and arrays of them to a message, little-endian.
class WireWriter {
 public:
  template <class T>
  requires std::is_arithmetic_v<T>
  void value(T number) { append(&number, sizeof number); }
  /// The count, then the items; T has no padding.
  template <class T>
  void array(const std::vector<T>& items) {
    static_assert(std::is_trivially_copyable_v<T>);
    value(std::uint64_t{items.size()});
    append(items.data(), items.size() * sizeof(T));
  }
  void rest(const protocol::Bytes& bytes) { append(bytes.data(), bytes.size()); }
  [[nodiscard]] protocol::Bytes take() { return std::move(bytes_); }

 private:
  void append(const void* data, std::size_t count) {
    const auto* const first = static_cast<const std::byte*>(data);
    bytes_.insert(bytes_.end(), first, first + count);
  }
  protocol::Bytes bytes_;
};

/// Takes them off again. No length is believed before the bytes for it are known to be there. Errors: ProtocolError
/// that names the sender.
class WireReader {
 public:
  WireReader(protocol::Rank sender, std::span<const std::byte> bytes) : sender_(sender), bytes_(bytes) {}

  template <class T>
  requires std::is_arithmetic_v<T>
  [[nodiscard]] T value() {
    T number;
    std::memcpy(&number, take(sizeof number).data(), sizeof number);
    return number;
  }
  template <class T>
  [[nodiscard]] std::vector<T> array() {
    static_assert(std::is_trivially_copyable_v<T>);
    const auto count = value<std::uint64_t>();
    if (count > bytes_.size() / sizeof(T)) fail("ends within an array of " + std::to_string(count) + " items");
    std::vector<T> items(static_cast<std::size_t>(count));
    const auto taken = take(items.size() * sizeof(T));
    if (!taken.empty()) std::memcpy(items.data(), taken.data(), taken.size());
    return items;
  }
  [[nodiscard]] protocol::Bytes rest() {
    const auto taken = take(bytes_.size());
    return {taken.begin(), taken.end()};
  }
  /// The message has been read to its end.
  void finish() const {
    if (!bytes_.empty()) fail("goes on after its end");
  }
  [[noreturn]] void fail(const std::string& what) const { throw protocol::ProtocolError(sender_, what); }
  [[nodiscard]] protocol::Rank sender() const { return sender_; }

 private:
  std::span<const std::byte> take(std::size_t count) {
    if (count > bytes_.size()) fail("ends too early");
    const auto taken = bytes_.first(count);
    bytes_ = bytes_.subspan(count);
    return taken;
  }
  protocol::Rank sender_;
  std::span<const std::byte> bytes_;
};

}  // namespace driftmesh
