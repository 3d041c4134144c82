#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <set>
#include <string>

#include "protocol/random_message.hpp"
#include "protocol/wire.hpp"
#include "support/id_literals.hpp"

using namespace driftmesh;
using namespace driftmesh::protocol;
using protocol::testing::kLimits;
using protocol::testing::RandomMessage;

namespace {

constexpr Rank kSender{5};

std::string error_of(const Bytes& bytes, const WireLimits& limits = kLimits) {
  try {
    static_cast<void>(decode(kSender, bytes, limits));
  } catch (const ProtocolError& error) {
    CHECK(error.sender() == kSender);
    CHECK(std::string(error.what()).starts_with("message from rank 5: "));
    return error.what();
  }
  return {};
}

// Whatever the bytes, decode either rejects them or decodes all of them.
bool refused_or_canonical(const Bytes& bytes) {
  try {
    return encode(decode(kSender, bytes, kLimits)) == bytes;
  } catch (const ProtocolError&) {
    return true;
  }
}

}  // namespace

TEST_CASE("messages of every type survive a round trip") {
  std::set<std::size_t> types;
  for (std::uint64_t seed = 1; seed <= 2000; ++seed) {
    CAPTURE(seed);
    const Message message = RandomMessage(seed).any();
    types.insert(message.index());
    const Bytes bytes = encode(message);
    REQUIRE(decode(kSender, bytes, kLimits) == message);
    REQUIRE(traffic_of(kSender, bytes) == traffic_of(message));
  }
  CHECK(types.size() == std::variant_size_v<Message>);
}

TEST_CASE("every truncation is refused") {
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    CAPTURE(seed);
    const Message message = RandomMessage(seed).any();
    if (std::holds_alternative<HandOff>(message) || std::holds_alternative<Advice>(message))
      continue;  // they extend to the end of the message; their reader checks them
    const Bytes bytes = encode(message);
    for (std::size_t length = 0; length < bytes.size(); ++length) {
      CAPTURE(length);
      REQUIRE(!error_of(Bytes(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(length))).empty());
    }
    Bytes longer = bytes;
    longer.push_back(std::byte{0});
    REQUIRE(!error_of(longer).empty());
  }
}

TEST_CASE("damaged bytes are rejected, or decode to another complete message") {
  std::mt19937_64 random(7);
  int refused = 0, understood = 0;
  for (std::uint64_t seed = 1; seed <= 3000; ++seed) {
    CAPTURE(seed);
    Bytes bytes = encode(RandomMessage(seed).any());
    for (auto flips = random() % 3 + 1; flips > 0; --flips)
      bytes[random() % bytes.size()] ^= std::byte(1u << (random() % 8));
    REQUIRE(refused_or_canonical(bytes));
    ++(error_of(bytes).empty() ? understood : refused);
  }
  CHECK(refused > 300);
  CHECK(understood > 300);
}

TEST_CASE("a SPLIT is 12 bytes on the wire") {
  SplitBatch batch{{SplitGroup{3_sub, 1, 2_rank, 0, {}}}};
  const std::size_t empty = encode(batch).size();
  CHECK(empty == 2 + 4 + kSplitGroupBytes + 4 - 4);
  for (dyadic::Path path = 1; path <= 512; ++path)
    batch.groups[0].points.push_back({static_cast<GlobalRootId>(path), path});
  CHECK(encode(batch).size() == empty + 512 * kSplitPointBytes);
}

TEST_CASE("the layout is little-endian and fixed") {
  const Bytes bytes = encode(LocationUpdate{0x01_sub, 0x02_rank, 0x0a0b0c0d});
  const std::vector<int> expected{2, 2, 1, 0, 0, 0, 2, 0, 0, 0, 0x0d, 0x0c, 0x0b, 0x0a};
  REQUIRE(bytes.size() == expected.size());
  for (std::size_t i = 0; i < bytes.size(); ++i) CHECK(std::to_integer<int>(bytes[i]) == expected[i]);
}

TEST_CASE("errors say what is wrong") {
  const auto with = [](Message message, std::size_t at, int value) {
    Bytes bytes = encode(message);
    bytes.at(at) = std::byte(value);
    return error_of(bytes);
  };
  CHECK(with(Finish{}, 0, 9) ==
        "message from rank 5: it has version 9, but this program uses 2; start the same build on every rank");
  CHECK(with(Token{1, 2, true}, 18, 2) == "message from rank 5: flag of value 2");
  CHECK(with(LocationUpdate{1_sub, 2_rank, 3}, 2, 100) == "message from rank 5: subdomain 100 is outside 0 .. 99");
  CHECK(with(LocationUpdate{1_sub, 2_rank, 3}, 9, 0xff) == "message from rank 5: rank -16777214 is outside 0 .. 6");
  CHECK(error_of(encode(SplitBatch{{{1_sub, 1, 1_rank, 0, {{1_root, 0}}}}})) ==
        "message from rank 5: split path 0 is invalid, or deeper than 60");
  CHECK(error_of({}) == "message from rank 5: it ends too early");
}

TEST_CASE("what is in transit when the work ends is told by the type of a message") {
  const auto check = [](const Message& message, Traffic traffic) {
    CHECK(traffic_of(message) == traffic);
    CHECK(traffic_of(kSender, encode(message)) == traffic);
  };
  check(SplitBatch{}, Traffic::kWork);
  check(HandOff{}, Traffic::kWork);
  check(LocationUpdate{}, Traffic::kControl);
  check(Advice{}, Traffic::kControl);
  check(Advice{9, {}}, Traffic::kControl);
  check(Abandon{}, Traffic::kControl);
  check(Token{}, Traffic::kDetection);
  check(Terminate{}, Traffic::kDetection);
  check(Finish{}, Traffic::kDetection);
}

TEST_CASE("values are read up to their bounds, and not beyond") {
  enum class Choice : std::uint8_t { kFirst, kSecond, kLast };
  // What comes back, or nothing where it is refused; `write` and `read` are calls of the two sides.
  const auto passes = [](const auto& write, const auto& read) {
    WireWriter writer;
    write(writer);
    const Bytes bytes = writer.take();
    WireReader reader(bytes, kLimits);
    try {
      read(reader);
      reader.end();
      return true;
    } catch (const Error&) {
      return false;
    }
  };
  const auto id_passes = [&](std::int32_t number, auto member, auto id) {
    return passes([&](WireWriter& w) { w.number(number); }, [&](WireReader& r) { (r.*member)(id); });
  };
  for (const std::int32_t number : {INT32_MIN, -1, 0, 6, 7, 8, 99, 100, 101, 999, 1000, 1001, INT32_MAX}) {
    CAPTURE(number);
    CHECK(id_passes(number, &WireReader::rank, Rank{}) == (number >= 0 && number < 7));
    CHECK(id_passes(number, &WireReader::subdomain, SubdomainId{}) == (number >= 0 && number < 100));
    CHECK(id_passes(number, &WireReader::root, GlobalRootId{}) == (number >= 0 && number < 1000));
  }
  for (int byte = 0; byte < 256; ++byte) {
    const auto write = [&](WireWriter& w) { w.number(static_cast<std::uint8_t>(byte)); };
    Choice choice{};
    CHECK(passes(write, [&](WireReader& r) { r.choice(choice, Choice::kLast); }) == (byte <= 2));
    if (byte <= 2) CHECK(static_cast<int>(choice) == byte);
    bool flag = byte == 0;
    CHECK(passes(write, [&](WireReader& r) { r.flag(flag); }) == (byte <= 1));
    if (byte <= 1) CHECK(flag == (byte == 1));
  }
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double value : {0.0, 5e-324, 1.5, 1e308, -5e-324, -1.0, infinity, -infinity, std::nan("")}) {
    CAPTURE(value);
    double amount = -1;
    const bool passed = passes([&](WireWriter& w) { w.amount(value); }, [&](WireReader& r) { r.amount(amount); });
    CHECK(passed == (value >= 0 && value < infinity));
    if (passed) CHECK(amount == value);
  }
  for (int depth = 0; depth < 64; ++depth) {
    CAPTURE(depth);
    for (const dyadic::Path path : {dyadic::Path{1} << depth, (dyadic::Path{2} << depth) - 1}) {
      dyadic::Path read = 0;
      const bool passed = passes([&](WireWriter& w) { w.path(path); }, [&](WireReader& r) { r.path(read); });
      CHECK(passed == (depth <= dyadic::kMaxDepth));
      if (passed) CHECK(read == path);
    }
  }
}

TEST_CASE("a length allocates no memory before its bytes are known to exist") {
  Bytes bytes = encode(SplitBatch{});
  for (std::size_t i = 2; i < 6; ++i) bytes[i] = std::byte{0xff};
  CHECK(error_of(bytes) == "message from rank 5: it announces 4294967295 items, but 0 bytes follow");
}

TEST_CASE("advice is carried unchanged, and its topic takes no extra bytes") {
  const Advice advice{9, Bytes{std::byte{0xab}, std::byte{0xcd}}};
  const Bytes bytes = encode(advice);
  CHECK(bytes.size() == 4);
  CHECK(decode(kSender, bytes, {}) == Message(advice));
  CHECK(decode(kSender, encode(Advice{}), {}) == Message(Advice{}));
  CHECK_THROWS_AS(static_cast<void>(encode(Advice{static_cast<std::uint8_t>(257 - std::variant_size_v<Message>), {}})),
                  LimitError);
}
