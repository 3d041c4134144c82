#include "base/bytes.hpp"

#include <doctest/doctest.h>

#include <cstdint>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "support/error_text.hpp"

using namespace driftmesh;
using namespace driftmesh::testing;

namespace {

enum class Color : std::uint8_t { kRed, kGreen };

std::vector<int> as_ints(const Bytes& bytes) {
  std::vector<int> ints;
  for (const std::byte b : bytes) ints.push_back(std::to_integer<int>(b));
  return ints;
}

template <class Read>
std::string error_of(const Bytes& bytes, const Read& read) {
  return error_text([&] {
    ByteReader reader(bytes);
    read(reader);
    reader.end();
  });
}

}  // namespace

TEST_CASE("numbers are little-endian on every machine") {
  ByteWriter writer;
  writer.number(std::uint32_t{0x01020304});
  writer.number(std::int16_t{-2});
  writer.number(Color::kGreen);
  writer.number(1.0);
  const Bytes bytes = writer.take();
  CHECK(as_ints(bytes) == std::vector<int>{4, 3, 2, 1, 0xfe, 0xff, 1, 0, 0, 0, 0, 0, 0, 0xf0, 0x3f});
  ByteReader reader(bytes);
  CHECK(reader.number<std::uint32_t>() == 0x01020304);
  CHECK(reader.number<std::int16_t>() == -2);
  CHECK(reader.number<Color>() == Color::kGreen);
  CHECK(reader.number<double>() == 1.0);
  CHECK(reader.at_end());
}

TEST_CASE("small numbers take few bytes, and all survive a round trip") {
  ByteWriter writer;
  writer.varint(127);
  writer.varint(300);
  writer.signed_varint(-1);
  CHECK(as_ints(writer.bytes()) == std::vector<int>{0x7f, 0xac, 0x02, 0x01});

  std::mt19937_64 random(3);
  std::vector<std::uint64_t> numbers{0, std::numeric_limits<std::uint64_t>::max()};
  for (int i = 0; i < 1000; ++i) numbers.push_back(random() >> (random() % 64));
  ByteWriter all;
  for (const std::uint64_t n : numbers) {
    all.varint(n);
    all.signed_varint(static_cast<std::int64_t>(n));
  }
  const Bytes bytes = all.take();
  ByteReader reader(bytes);
  for (const std::uint64_t n : numbers) {
    REQUIRE(reader.varint() == n);
    REQUIRE(reader.signed_varint() == static_cast<std::int64_t>(n));
  }
  CHECK(reader.at_end());
}

TEST_CASE("values, arrays and texts survive a round trip") {
  ByteWriter writer;
  writer.value(true);
  writer.array(std::vector<double>{1, 2});
  writer.array(std::vector<int>{});
  writer.text("a text");
  const Bytes bytes = writer.take();
  ByteReader reader(bytes);
  CHECK(reader.value<bool>());
  std::vector<double> doubles;
  reader.array(doubles);
  CHECK(doubles == std::vector<double>{1, 2});
  std::vector<int> none{7};
  reader.array(none);
  CHECK(none.empty());
  CHECK(reader.text() == "a text");
  CHECK_NOTHROW(reader.end());
}

TEST_CASE("bytes that are too short, too long or announce too much are errors, and cost no memory") {
  const auto read_number = [](ByteReader& in) { static_cast<void>(in.number<std::uint32_t>()); };
  CHECK(error_of(Bytes(4), read_number) == "no error");
  CHECK(error_of(Bytes(3), read_number) == "it ends too early");
  CHECK(error_of(Bytes(5), read_number) == "it goes on after its end");
  const auto read_array = [](ByteReader& in) {
    std::vector<double> values;
    in.array(values);
  };
  CHECK(error_of(Bytes(16, std::byte{0xff}), read_array) == "it ends too early");
  const auto read_varint = [](ByteReader& in) { static_cast<void>(in.varint()); };
  CHECK(error_of(Bytes(9, std::byte{0x80}), read_varint) == "it ends too early");
  CHECK(error_of(Bytes(20, std::byte{0x80}), read_varint) == "it has a number that is too long");
}
