#pragma once

#include <array>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "base/bytes.hpp"
#include "base/narrow.hpp"
#include "driftmesh/ids.hpp"
#include "dyadic/path.hpp"
#include "protocol/protocol_error.hpp"

/// Building blocks of message codecs. One description of each layout serves both directions: fields(archive, message)
/// passes the fields to the archive in order; a WireWriter appends them, a WireReader extracts and checks them.
namespace driftmesh::protocol {

/// Upper limits of the IDs in a message; none may be negative.
struct WireLimits {
  std::int32_t ranks = 0;
  std::int32_t subdomains = 0;
  std::int32_t roots = 0;  ///< roots in the decomposition
};

/// A message of type M, to be written or to be read.
template <class T, class M>
concept MessageOf = std::same_as<std::remove_const_t<T>, M>;

class WireWriter {
 public:
  template <std::integral T>
  void number(T value) {
    out_.number(value);
  }
  void root(GlobalRootId value) { out_.number(value); }
  void rank(Rank value) { out_.number(value); }
  void subdomain(SubdomainId value) { out_.number(value); }
  void path(dyadic::Path value) { out_.number(value); }
  void flag(bool value) { out_.number(static_cast<std::uint8_t>(value ? 1 : 0)); }
  template <class Enum>
  void choice(Enum value, Enum /*last*/) {
    out_.number(value);
  }
  void amount(double value) { out_.number(value); }
  void rest(const Bytes& value) { out_.raw(value); }
  /// A count and the items, `bytes_each` at least, each by fields(archive, item). Throws LimitError for more than
  /// 2^32 - 1 of them.
  template <class T, class Fields>
  void list(const std::vector<T>& items, std::size_t bytes_each, const Fields& fields) {
    out_.number(narrow<std::uint32_t>(items.size(), "items in one message"));
    out_.reserve(items.size() * bytes_each);
    for (const T& item : items) fields(*this, item);
  }

  [[nodiscard]] Bytes take() { return out_.take(); }

 private:
  ByteWriter out_;
};

/// Throws Error for data that no WireWriter has written, or that is out of range. No length is trusted before the bytes
/// for it are known to be there.
class WireReader {
 public:
  WireReader(std::span<const std::byte> bytes, const WireLimits& limits) : in_(bytes), limits_(limits) {}

  template <std::integral T>
  void number(T& value) {
    value = in_.number<T>();
  }
  void root(GlobalRootId& value) { bounded(value, limits_.roots, "root"); }
  void rank(Rank& value) { bounded(value, limits_.ranks, "rank"); }
  void subdomain(SubdomainId& value) { bounded(value, limits_.subdomains, "subdomain"); }
  void path(dyadic::Path& value) {
    number(value);
    if (value == 0 || dyadic::depth(value) > dyadic::kMaxDepth)
      throw Error("split path " + std::to_string(value) + " is invalid, or deeper than " +
                  std::to_string(dyadic::kMaxDepth));
  }
  void flag(bool& value) {
    const auto byte = in_.number<std::uint8_t>();
    if (byte > 1) throw Error("flag of value " + std::to_string(byte));
    value = byte == 1;
  }
  /// A value of a byte enumeration that starts at 0.
  template <class Enum>
  void choice(Enum& value, Enum last) {
    const auto byte = in_.number<std::uint8_t>();
    if (byte > static_cast<std::uint8_t>(last)) throw Error("choice " + std::to_string(byte) + " does not exist");
    value = static_cast<Enum>(byte);
  }
  void amount(double& value) {
    value = in_.number<double>();
    if (!std::isfinite(value) || value < 0) throw Error("an amount is negative or not finite");
  }
  void rest(Bytes& value) {
    const auto taken = in_.raw(in_.left());
    value.assign(taken.begin(), taken.end());
  }
  template <class T, class Fields>
  void list(std::vector<T>& items, std::size_t bytes_each, const Fields& fields) {
    const auto count = in_.number<std::uint32_t>();
    if (count > in_.left() / bytes_each)
      throw Error("it announces " + std::to_string(count) + " items, but " + std::to_string(in_.left()) +
                  " bytes follow");
    items.resize(count);
    for (T& item : items) fields(*this, item);
  }

  /// Throws Error if anything is left.
  void end() const { in_.end(); }

 private:
  template <class Id>
  void bounded(Id& value, std::int32_t limit, const char* what) {
    const auto number = in_.number<std::int32_t>();
    if (number < 0 || number >= limit)
      throw Error(std::string(what) + " " + std::to_string(number) + " is outside 0 .. " + std::to_string(limit - 1));
    value = Id{number};
  }

  ByteReader in_;
  WireLimits limits_;
};

/// The message of the variant's type number `type`, without content.
template <class Variant>
[[nodiscard]] Variant empty_message(std::size_t type) {
  static constexpr auto kEmpty = []<std::size_t... I>(std::index_sequence<I...>) {
    return std::array<Variant (*)(), sizeof...(I)>{[] { return Variant(std::in_place_index<I>); }...};
  }
  (std::make_index_sequence<std::variant_size_v<Variant>>());
  return kEmpty.at(type)();
}

}  // namespace driftmesh::protocol
