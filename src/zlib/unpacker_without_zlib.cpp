#include "base/built_without.hpp"
#include "zlib/unpacker.hpp"

namespace driftmesh {

struct Unpacker::Stream {};

Unpacker::Unpacker(const std::string& file) {
  throw built_without("zlib", "ZLIB", file, "write it without compression");
}

Unpacker::~Unpacker() = default;

void Unpacker::begin(std::string_view /*packed*/) {}

std::size_t Unpacker::take(char* /*to*/, std::size_t /*count*/) {
  return 0;
}

bool Unpacker::at_end() const {
  return true;
}

}  // namespace driftmesh
