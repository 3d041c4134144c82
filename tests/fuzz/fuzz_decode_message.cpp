// Bytes from another rank: rejected with an error that names the sender, or decoded completely, in which case the
// message encodes to the same bytes.
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <string_view>

#include "protocol/codec.hpp"

using namespace driftmesh;
using namespace driftmesh::protocol;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Bytes bytes(size);
  if (size != 0) std::memcpy(bytes.data(), data, size);
  try {
    if (encode(decode(Rank{3}, bytes, {.ranks = 8, .subdomains = 1000, .roots = 100'000})) != bytes) std::abort();
  } catch (const ProtocolError& error) {
    if (!std::string_view(error.what()).starts_with("message from rank 3: ")) std::abort();
  }
  return 0;
}
