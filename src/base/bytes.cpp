#include "base/bytes.hpp"

namespace driftmesh {

// Not inline: GCC 12 sees writes beyond the end where numbers are appended one after the other.
void ByteWriter::append(const void* data, std::size_t size) {
  const auto* const first = static_cast<const std::byte*>(data);
  bytes_.insert(bytes_.end(), first, first + size);
}

}  // namespace driftmesh
