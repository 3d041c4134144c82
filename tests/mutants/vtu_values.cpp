#include "mutants/vtu_values.hpp"

#include <bit>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <string>

namespace driftmesh::mutants {
namespace {

constexpr VtuType kTypes[] = {
    {"Float64", 8, true, true, Field::Kind::kFloat64}, {"Float32", 4, true, true, Field::Kind::kFloat32},
    {"Int8", 1, false, true, Field::Kind::kInt8},      {"UInt8", 1, false, false, Field::Kind::kInt8},
    {"Int16", 2, false, true, Field::Kind::kInt8},     {"UInt16", 2, false, false, Field::Kind::kInt8},
    {"Int32", 4, false, true, Field::Kind::kInt32},    {"UInt32", 4, false, false, Field::Kind::kInt32},
    {"Int64", 8, false, true, Field::Kind::kInt64},    {"UInt64", 8, false, false, Field::Kind::kInt64}};

}  // namespace

const VtuType& vtu_type_of(const Element& array) {
  for (const VtuType& type : kTypes)
    if (array.attribute("type") == type.name) return type;
  throw Undeclared("an array of unknown type");
}

void add_bytes(const VtuType& type, const char* bytes, VtuValues& values) {
  std::uint64_t word = 0;
  std::memcpy(&word, bytes, type.size);
  if (type.is_real) {
    values.add(
        type, type.size == 8 ? std::bit_cast<double>(word) : std::bit_cast<float>(static_cast<std::uint32_t>(word)), 0);
    return;
  }
  const std::size_t unused = 64 - 8 * type.size;
  const std::int64_t integer =
      type.is_signed ? static_cast<std::int64_t>(word << unused) >> unused : static_cast<std::int64_t>(word);
  const bool is_too_large = !type.is_signed && integer < 0;
  values.has_too_large |= is_too_large;
  values.add(type, is_too_large ? static_cast<double>(word) : static_cast<double>(integer), integer);
}

void add_text(const VtuType& type, std::string_view text, VtuValues& values) {
  if (type.is_real) {
    const std::optional<double> real = real_number(text);
    if (!real) throw Undeclared("no number");
    values.add(type, type.size == 8 ? *real : std::strtof(std::string(text).c_str(), nullptr), 0);
    return;
  }
  const std::optional<std::int64_t> integer = whole_number(text);
  if (!integer) throw Undeclared("no whole number");
  const double low = type.is_signed ? -std::ldexp(1, static_cast<int>(8 * type.size) - 1) : 0;
  const double high = std::ldexp(1, static_cast<int>(8 * type.size) - (type.is_signed ? 1 : 0));
  const auto real = static_cast<double>(*integer);
  if (real < low || (type.size < 8 && real >= high)) throw Undeclared("a number that its type does not have");
  values.add(type, real, *integer);
}

}  // namespace driftmesh::mutants
