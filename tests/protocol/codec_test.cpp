#include <doctest/doctest.h>

#include <set>

#include "protocol/random_message.hpp"
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
