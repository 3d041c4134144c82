#pragma once

#include "base/bytes.hpp"
#include "job/value.hpp"

namespace driftmesh::job {

/// A value as bytes. Not for lists of records. Reading throws Error for bytes that are no value.
void write_value(ByteWriter& writer, const Value& value);
[[nodiscard]] Value read_value(ByteReader& reader);

}  // namespace driftmesh::job
