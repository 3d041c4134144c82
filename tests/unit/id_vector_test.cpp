#include "driftmesh/id_vector.hpp"

#include <doctest/doctest.h>

#include <concepts>
#include <cstdint>
#include <stdexcept>
#include <string>

using namespace driftmesh;

namespace {

enum class Apple : std::int32_t {};
enum class Pear : std::int32_t {};

template <class Vector, class Id>
concept IndexedBy = requires(Vector v, Id id) {
  v[id];
};

}  // namespace

TEST_CASE("a vector is indexed by numbers of its own kind alone") {
  CHECK(IndexedBy<IdVector<Apple, double>, Apple>);
  CHECK_FALSE(IndexedBy<IdVector<Apple, double>, Pear>);
  CHECK_FALSE(IndexedBy<IdVector<Apple, double>, std::size_t>);
  CHECK_FALSE(IndexedBy<IdVector<Apple, double>, int>);
  CHECK(IndexedBy<IdSpan<Apple, const double>, Apple>);
  CHECK_FALSE(IndexedBy<IdSpan<Apple, const double>, Pear>);
  CHECK(std::convertible_to<const IdVector<Apple, double>&, IdSpan<Apple, const double>>);
  CHECK_FALSE(std::convertible_to<const IdVector<Pear, double>&, IdSpan<Apple, const double>>);

  IdVector<Apple, double> weights{1.5, 2.5};
  weights[Apple{1}] = 3;
  const Apple third = weights.next_id();
  weights.push_back(4);
  CHECK(weights[Apple{0}] == 1.5);
  CHECK(weights[Apple{1}] == 3);
  CHECK(weights[third] == 4);
  CHECK_THROWS_AS((void)weights.at(Apple{3}), std::out_of_range);
  CHECK_THROWS_AS((void)weights.at(Apple{-1}), std::out_of_range);

  const IdSpan<Apple, const double> view(weights);
  CHECK(&view[third] == &weights[third]);
}

TEST_CASE("plain integers and small enumerations can be indices too") {
  IdVector<std::int32_t, bool> taken(3);
  taken[2] = true;
  CHECK_FALSE(taken[0]);
  CHECK(taken[2]);

  enum Side { kLeft, kRight };
  IdVector<Side, char> letters{'l', 'r'};
  CHECK(letters[kRight] == 'r');
}

TEST_CASE("the numbers of all elements are visited in order") {
  const IdVector<Apple, char> letters{'a', 'b', 'c'};
  std::string seen;
  for (const Apple a : ids_of(letters)) seen += letters[a];
  CHECK(seen == "abc");
  std::int32_t sum = 0;
  for (const Apple a : first_ids<Apple>(4)) sum = 10 * sum + to_int(a);
  CHECK(sum == 123);
  for ([[maybe_unused]] const Apple a : ids_of(IdVector<Apple, char>())) FAIL("there is none");
}

TEST_CASE("a vector knows which numbers it has") {
  const IdVector<Pear, int> values(2, 7);
  CHECK(values.has(Pear{0}));
  CHECK(values.has(Pear{1}));
  CHECK_FALSE(values.has(Pear{2}));
  CHECK_FALSE(values.has(Pear{-1}));
}

TEST_CASE("kNone is -1 as a number of any signed kind") {
  const std::int32_t plain = kNone;
  CHECK(plain == -1);
  CHECK(plain == kNone);
  CHECK(0 != kNone);
  const IdVector<std::int32_t, int> values(3);
  CHECK_FALSE(values.has(kNone));
  // A 16-bit label would become 65535, which may be a valid one.
  static_assert(!std::is_convertible_v<NoId, std::uint16_t>);
}
