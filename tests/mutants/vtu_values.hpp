#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "mutants/fields.hpp"
#include "mutants/xml_tree.hpp"

// The values in arrays of VTK, in all types: a second reader, which shares nothing with that in src/io.

namespace driftmesh::mutants {

struct VtuType {
  const char* name;  ///< in files
  std::size_t size;
  bool is_real;
  bool is_signed;
  Field::Kind kind;
};
/// Throws Undeclared.
[[nodiscard]] const VtuType& vtu_type_of(const Element& array);

/// The values of an array; of a type of whole numbers, in both forms.
struct VtuValues {
  std::vector<double> reals;
  std::vector<std::int64_t> integers;
  bool has_too_large = false;  ///< some value is too large for an integer here

  void add(const VtuType& type, double real, std::int64_t integer) {
    reals.push_back(real);
    if (!type.is_real) integers.push_back(integer);
  }
};

/// Adds a value from its bytes, in little-endian order.
void add_bytes(const VtuType& type, const char* bytes, VtuValues& values);
/// Throws Undeclared for what is no value of this type.
void add_text(const VtuType& type, std::string_view text, VtuValues& values);

}  // namespace driftmesh::mutants
