#pragma once

#include <span>
#include <vector>

#include "adapt/fields.hpp"
#include "adapt/generation.hpp"
#include "base/bytes.hpp"
#include "driftmesh/ids.hpp"
#include "migration/packed_form.hpp"

namespace driftmesh::adapt {

/// The values that fields have on one part, field by field in the order of their names: at its vertices, its triangles
/// or their corners, in the order of memory.
using ValuesOnPart = std::vector<std::vector<double>>;

[[nodiscard]] ValuesOnPart values_on(const Generation& generation, SubdomainId s, const Fields& fields);
/// Sets what the fields, which have room for it, have on a part that is here.
void set_values_on(const Generation& generation, SubdomainId s, const ValuesOnPart& values, Fields& fields);
/// The same fields for another generation, with room for values on all of its piece.
[[nodiscard]] Fields without_values(const Fields& fields, const DistributedPiece& piece);

/// A part with what it carries, as it travels to another rank or is saved.
struct Parcel {
  SubdomainId id{};
  Part part;
  ValuesOnPart values;
};

/// Contains the packed form of the subdomain (docs/file-formats.md): a mesh that goes on from it is bit for bit the one
/// that would have gone on from the part.
[[nodiscard]] Bytes pack(SubdomainId s, const Part& part, const ValuesOnPart& values);
[[nodiscard]] Bytes pack(const Generation& generation, SubdomainId s, const Fields& fields);
/// The number of these bytes, without the time and memory that they take.
[[nodiscard]] std::uint64_t packed_size(const Generation& generation, SubdomainId s, const Fields& fields);
/// Throws Error for bytes that are no such parcel.
[[nodiscard]] Parcel unpack_parcel(std::span<const std::byte> bytes, Source source);

}  // namespace driftmesh::adapt
