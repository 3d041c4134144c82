#include "protocol/codec.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <concepts>
#include <cstring>
#include <string>
#include <type_traits>
#include <utility>

#include "base/narrow.hpp"

namespace driftmesh::protocol {
namespace {

// One description of each layout serves both directions: fields(archive, message) hands the archive one field after
// the other, and a Writer appends them, a Reader fetches and checks them.

template <class T, class Struct>
concept Is = std::same_as<std::remove_const_t<T>, Struct>;

void fields(auto& archive, Is<SplitPoint<GlobalRootId>> auto& m) {
  archive.root(m.root);
  archive.path(m.path);
}
void fields(auto& archive, Is<SplitGroup> auto& m) {
  archive.subdomain(m.to);
  archive.number(m.epoch);
  archive.rank(m.origin);
  archive.number(m.hops);
  archive.list(m.points, kSplitPointBytes);
}
void fields(auto& archive, Is<SplitBatch> auto& m) {
  archive.list(m.groups, kSplitGroupBytes);
}
void fields(auto& archive, Is<HandOff> auto& m) {
  archive.subdomain(m.subdomain);
  archive.number(m.epoch);
  archive.rest(m.packed);
}
void fields(auto& archive, Is<LocationUpdate> auto& m) {
  archive.subdomain(m.subdomain);
  archive.rank(m.owner);
  archive.number(m.epoch);
}
void fields(auto& archive, Is<SubdomainLoad> auto& m) {
  archive.subdomain(m.subdomain);
  archive.number(m.epoch);
  archive.amount(m.remaining);
  archive.number(m.bytes);
}
void fields(auto& archive, Is<LoadReport> auto& m) {
  archive.number(m.round);
  archive.number(m.plan);
  archive.amount(m.speed);
  archive.list(m.loads, 24);
}
void fields(auto& archive, Is<PlannedMove> auto& m) {
  archive.subdomain(m.subdomain);
  archive.rank(m.destination);
}
void fields(auto& archive, Is<Plan> auto& m) {
  archive.number(m.round);
  archive.list(m.moves, 8);
}
void fields(auto& archive, Is<LoadNews> auto& m) {
  archive.number(m.round);
  archive.amount(m.remaining);
  archive.amount(m.spare);
  archive.amount(m.speed);
}
void fields(auto& archive, Is<WorkRequest> auto& m) {
  archive.rank(m.thief);
  archive.number(m.round);
  archive.amount(m.remaining);
  archive.amount(m.speed);
  archive.number(m.rivals);
}
void fields(auto& archive, Is<WorkAnswer> auto& m) {
  archive.number(m.round);
  archive.list(m.moves, 8);
}
void fields(auto& archive, Is<JointRound> auto& m) {
  archive.number(m.round);
  archive.choice(m.stage, JointRound::Stage::kStart);
}
void fields(auto& archive, Is<Token> auto& m) {
  archive.number(m.round);
  archive.number(m.count);
  archive.flag(m.black);
}
void fields(auto& archive, Is<Terminate> auto& m) {
  archive.number(m.pass);
  archive.number(m.work);
  archive.number(m.control);
}
void fields(auto&, Is<Finish> auto&) {}

class Writer {
 public:
  template <std::integral T>
  void number(T value) {
    const auto bits = static_cast<std::make_unsigned_t<T>>(value);
    for (std::size_t i = 0; i < sizeof(T); ++i) bytes_.push_back(static_cast<std::byte>(bits >> (8 * i) & 0xff));
  }
  void root(GlobalRootId value) { number(to_int(value)); }
  void rank(Rank value) { number(to_int(value)); }
  void subdomain(SubdomainId value) { number(to_int(value)); }
  void path(dyadic::Path value) { number(value); }
  void flag(bool value) { number<std::uint8_t>(value ? 1 : 0); }
  template <class Enum>
  void choice(Enum value, Enum /*last*/) {
    number(static_cast<std::uint8_t>(value));
  }
  void amount(double value) { number(std::bit_cast<std::uint64_t>(value)); }
  void rest(const Bytes& value) { bytes_.insert(bytes_.end(), value.begin(), value.end()); }
  template <class T>
  void list(const std::vector<T>& items, std::size_t bytes_each) {
    number(narrow<std::uint32_t>(items.size(), "items in one message"));
    bytes_.reserve(bytes_.size() + items.size() * bytes_each);
    for (const T& item : items) fields(*this, item);
  }

  [[nodiscard]] Bytes take() { return std::move(bytes_); }

 private:
  Bytes bytes_;
};

class Reader {
 public:
  Reader(Rank sender, std::span<const std::byte> bytes, const WireLimits& limits)
      : sender_(sender), bytes_(bytes), limits_(limits) {}

  template <std::integral T>
  void number(T& value) {
    std::make_unsigned_t<T> bits = 0;
    const auto taken = take(sizeof(T));
    for (std::size_t i = 0; i < sizeof(T); ++i)
      bits = static_cast<std::make_unsigned_t<T>>(bits | std::to_integer<std::make_unsigned_t<T>>(taken[i]) << (8 * i));
    value = static_cast<T>(bits);
  }
  void root(GlobalRootId& value) { index(value, limits_.roots, "root"); }
  void rank(Rank& value) { index(value, limits_.ranks, "rank"); }
  void subdomain(SubdomainId& value) { index(value, limits_.subdomains, "subdomain"); }
  void path(dyadic::Path& value) {
    number(value);
    if (value == 0 || dyadic::depth(value) > dyadic::kMaxDepth)
      fail("split path " + std::to_string(value) + " is none, or deeper than " + std::to_string(dyadic::kMaxDepth));
  }
  void flag(bool& value) {
    std::uint8_t byte = 0;
    number(byte);
    if (byte > 1) fail("flag of value " + std::to_string(byte));
    value = byte == 1;
  }
  /// One of an enumeration over bytes that begins at 0.
  template <class Enum>
  void choice(Enum& value, Enum last) {
    std::uint8_t byte = 0;
    number(byte);
    if (byte > static_cast<std::uint8_t>(last)) fail("choice " + std::to_string(byte) + " does not exist");
    value = static_cast<Enum>(byte);
  }
  void amount(double& value) {
    std::uint64_t bits = 0;
    number(bits);
    value = std::bit_cast<double>(bits);
    if (!std::isfinite(value) || value < 0) fail("an amount is negative or not finite");
  }
  void rest(Bytes& value) {
    const auto taken = take(bytes_.size());
    value.assign(taken.begin(), taken.end());
  }
  template <class T>
  void list(std::vector<T>& items, std::size_t bytes_each) {
    std::uint32_t count = 0;
    number(count);
    if (count > bytes_.size() / bytes_each)
      fail("announces " + std::to_string(count) + " items, and " + std::to_string(bytes_.size()) + " bytes follow");
    items.resize(count);
    for (T& item : items) fields(*this, item);
  }

  [[nodiscard]] bool at_end() const { return bytes_.empty(); }
  [[noreturn]] void fail(const std::string& what) const { throw ProtocolError(sender_, what); }

 private:
  std::span<const std::byte> take(std::size_t size) {
    if (size > bytes_.size()) fail("ends too early");
    const auto taken = bytes_.first(size);
    bytes_ = bytes_.subspan(size);
    return taken;
  }
  template <IsId Id>
  void index(Id& value, std::int32_t limit, const char* what) {
    std::int32_t plain = 0;
    number(plain);
    if (plain < 0 || plain >= limit)
      fail(std::string(what) + " " + std::to_string(plain) + " is outside 0 .. " + std::to_string(limit - 1));
    value = static_cast<Id>(plain);
  }

  Rank sender_;
  std::span<const std::byte> bytes_;
  WireLimits limits_;
};

template <std::size_t... I>
constexpr auto empty_messages(std::index_sequence<I...>) {
  return std::array<Message (*)(), sizeof...(I)>{[] { return Message(std::in_place_index<I>); }...};
}

// An empty message of the type that the two bytes in front of every message name.
Message read_head(Reader& reader) {
  static constexpr auto kEmpty = empty_messages(std::make_index_sequence<std::variant_size_v<Message>>());
  std::uint8_t version = 0, type = 0;
  reader.number(version);
  if (version != kWireVersion)
    reader.fail("has version " + std::to_string(version) + " where this program speaks " +
                std::to_string(kWireVersion) + "; start the same build on every rank");
  reader.number(type);
  if (type >= kEmpty.size()) reader.fail("has the unknown type " + std::to_string(type));
  return kEmpty[type]();
}

}  // namespace

Bytes encode(const Message& message) {
  Writer writer;
  writer.number(kWireVersion);
  writer.number(static_cast<std::uint8_t>(message.index()));
  std::visit([&](const auto& m) { fields(writer, m); }, message);
  return writer.take();
}

Message decode(Rank sender, std::span<const std::byte> bytes, const WireLimits& limits) {
  Reader reader(sender, bytes, limits);
  Message message = read_head(reader);
  std::visit([&](auto& m) { fields(reader, m); }, message);
  if (!reader.at_end()) reader.fail("goes on after its end");
  return message;
}

Traffic traffic_of(const Message& message) {
  if (std::holds_alternative<SplitBatch>(message) || std::holds_alternative<HandOff>(message)) return Traffic::kWork;
  if (std::holds_alternative<Token>(message) || std::holds_alternative<Terminate>(message) ||
      std::holds_alternative<Finish>(message))
    return Traffic::kDetection;
  return Traffic::kControl;
}

Traffic traffic_of(Rank sender, std::span<const std::byte> bytes) {
  Reader reader(sender, bytes, {});
  return traffic_of(read_head(reader));
}

}  // namespace driftmesh::protocol
