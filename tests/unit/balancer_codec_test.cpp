#include <doctest/doctest.h>

#include <cstdint>
#include <random>
#include <set>
#include <string>
#include <variant>
#include <vector>

#include "balancer/snapshot/codec.hpp"
#include "protocol/protocol_error.hpp"
#include "protocol/wire.hpp"
#include "support/id_literals.hpp"

using namespace driftmesh;
using namespace driftmesh::balancer;
using protocol::Advice;
using protocol::ProtocolError;

namespace {

constexpr Rank kSender{5};
constexpr protocol::WireLimits kLimits{.ranks = 7, .subdomains = 100, .roots = 0};

/// Messages of every type, with numbers over their whole range, in each member: taken apart, so that one more member
/// does not compile.
class RandomMessage {
 public:
  explicit RandomMessage(std::uint64_t seed) : random_(seed) {}

  Message any() {
    Message message = protocol::empty_message<Message>(below(std::variant_size_v<Message>));
    std::visit([&](auto& m) { fill(m); }, message);
    return message;
  }

 private:
  void fill(LoadReport& m) {
    auto& [round, plan, speed, loads, doubt, unlisted, free_memory] = m;
    set(round, plan, speed, loads, doubt, unlisted, free_memory);
  }
  void fill(ReportedLoad& m) {
    auto& [subdomain, epoch, remaining, bytes] = m;
    set(subdomain, epoch, remaining, bytes);
  }
  void fill(Plan& m) {
    auto& [round, moves, ask] = m;
    set(round, moves, ask);
  }
  void fill(Move& m) {
    auto& [subdomain, destination] = m;
    set(subdomain, destination);
  }
  void fill(LoadNews& m) {
    auto& [round, remaining, spare, speed, doubt, free_memory] = m;
    set(round, remaining, spare, speed, doubt, free_memory);
  }
  void fill(WorkRequest& m) {
    auto& [thief, round, remaining, speed, rivals, doubt, free_memory, horizon] = m;
    set(thief, round, remaining, speed, rivals, doubt, free_memory, horizon);
  }
  void fill(WorkAnswer& m) {
    auto& [round, moves] = m;
    set(round, moves);
  }
  void fill(Admission::Guest& m) {
    auto& [subdomain, triangles] = m;
    set(subdomain, triangles);
  }
  void fill(Admission& m) {
    auto& [round, stage, guests] = m;
    set(round, stage, guests);
  }

  void set(auto&... members) { (fill(members), ...); }
  template <class T>
  void fill(std::vector<T>& items) {
    items.resize(below(5));
    for (T& item : items) fill(item);
  }
  void fill(Rank& r) { r = static_cast<Rank>(below(to_index(kLimits.ranks))); }
  void fill(SubdomainId& s) { s = static_cast<SubdomainId>(below(to_index(kLimits.subdomains))); }
  void fill(Admission::Stage& stage) { stage = static_cast<Admission::Stage>(below(3)); }
  void fill(std::uint32_t& number) { number = static_cast<std::uint32_t>(random_()); }
  void fill(std::uint64_t& number) { number = random_(); }
  void fill(double& amount) { amount = static_cast<double>(random_()) / 3; }
  std::uint64_t below(std::uint64_t n) { return random_() % n; }

  std::mt19937_64 random_;
};

std::string error_of(const Advice& advice) {
  try {
    static_cast<void>(decode(kSender, advice, kLimits));
  } catch (const ProtocolError& error) {
    CHECK(error.sender() == kSender);
    CHECK(std::string(error.what()).starts_with("message from rank 5: "));
    return error.what();
  }
  return {};
}

// Whatever the bytes, decode either rejects them or decodes all of them.
bool refused_or_canonical(const Advice& advice) {
  try {
    return encode(decode(kSender, advice, kLimits)) == advice;
  } catch (const ProtocolError&) {
    return true;
  }
}

}  // namespace

TEST_CASE("the balancer's messages of every type survive a round trip") {
  std::set<std::size_t> types;
  for (std::uint64_t seed = 1; seed <= 2000; ++seed) {
    CAPTURE(seed);
    const Message message = RandomMessage(seed).any();
    types.insert(message.index());
    REQUIRE(decode(kSender, encode(message), kLimits) == message);
  }
  CHECK(types.size() == std::variant_size_v<Message>);
}

TEST_CASE("every truncation of the balancer's messages is rejected") {
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    CAPTURE(seed);
    Advice advice = encode(RandomMessage(seed).any());
    advice.content.push_back(std::byte{0});
    REQUIRE(error_of(advice) != "");
    advice.content.pop_back();
    REQUIRE(error_of(advice) == "");
    while (!advice.content.empty()) {
      advice.content.pop_back();
      REQUIRE(error_of(advice) != "");
    }
  }
}

TEST_CASE("damaged advice is rejected, or decodes to another complete message") {
  std::mt19937_64 random(7);
  int refused = 0, understood = 0;
  for (std::uint64_t seed = 1; seed <= 3000; ++seed) {
    CAPTURE(seed);
    Advice advice = encode(RandomMessage(seed).any());
    if (random() % 10 == 0) advice.topic = static_cast<std::uint8_t>(random() % 8);
    for (auto flips = random() % 3 + 1; flips > 0; --flips)
      advice.content[random() % advice.content.size()] ^= std::byte(1u << (random() % 8));
    REQUIRE(refused_or_canonical(advice));
    ++(error_of(advice).empty() ? understood : refused);
  }
  CHECK(refused > 300);
  CHECK(understood > 300);
}

TEST_CASE("the layout of a plan is little-endian and fixed") {
  const Advice advice = encode(Plan{0x0a0b0c0d, {{1_sub, 2_rank}}, {3_rank}});
  CHECK(advice.topic == 1);
  const std::vector<int> expected{0x0d, 0x0c, 0x0b, 0x0a, 1, 0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0, 1, 0, 0, 0, 3, 0, 0, 0};
  REQUIRE(advice.content.size() == expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) CHECK(std::to_integer<int>(advice.content[i]) == expected[i]);
}

TEST_CASE("errors about advice say what is wrong") {
  const auto with = [](const Message& message, std::size_t at, int value) {
    Advice advice = encode(message);
    advice.content.at(at) = std::byte(value);
    return error_of(advice);
  };
  CHECK(error_of(encode(LoadReport{1, 0, -1.0, {}})) == "message from rank 5: an amount is negative or not finite");
  CHECK(error_of(encode(LoadNews{1, 1.0, 2.0, -0.5})) == "message from rank 5: an amount is negative or not finite");
  CHECK(error_of(encode(WorkRequest{7_rank, 1, 1.0, 2.0, 0})) == "message from rank 5: rank 7 is outside 0 .. 6");
  CHECK(error_of(encode(Plan{1, {{100_sub, 1_rank}}, {}})) == "message from rank 5: subdomain 100 is outside 0 .. 99");
  CHECK(with(Admission{1, Admission::Stage::kReturn, {}}, 4, 3) == "message from rank 5: choice 3 does not exist");
  CHECK(error_of(encode(Plan{1, {}, {7_rank}})) == "message from rank 5: rank 7 is outside 0 .. 6");
  for (const int topic : {6, 7, 255})
    CHECK(error_of({static_cast<std::uint8_t>(topic), {}}) ==
          "message from rank 5: it is advice on the unknown topic " + std::to_string(topic));
  CHECK(error_of({0, {}}) == "message from rank 5: it ends too early");
}

TEST_CASE("a length in advice allocates no memory before its bytes are known to exist") {
  Advice advice = encode(Plan{1, {}, {}});
  for (std::size_t i = 4; i < 8; ++i) advice.content[i] = std::byte{0xff};
  CHECK(error_of(advice) == "message from rank 5: it announces 4294967295 items, but 4 bytes follow");
}
