// Load balancing messages from another rank: rejected with an error that names the sender, or decoded completely, in
// which case the message encodes to the same bytes. The first byte of the input is the topic.
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <string_view>

#include "balancer/snapshot/codec.hpp"
#include "protocol/protocol_error.hpp"

using namespace driftmesh;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  protocol::Advice advice{data[0], Bytes(size - 1)};
  if (size > 1) std::memcpy(advice.content.data(), data + 1, size - 1);
  try {
    const balancer::Message message =
        balancer::decode(Rank{3}, advice, {.ranks = 8, .subdomains = 1000, .roots = 100'000});
    if (balancer::encode(message) != advice) std::abort();
  } catch (const protocol::ProtocolError& error) {
    if (!std::string_view(error.what()).starts_with("message from rank 3: ")) std::abort();
  }
  return 0;
}
