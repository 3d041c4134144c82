#include "zlib/unpacker.hpp"

#include <zlib.h>

#include <algorithm>
#include <new>

namespace driftmesh {

struct Unpacker::Stream {
  z_stream state{};
  std::string_view packed;  // what is left of the block
  bool at_end = false;
};

Unpacker::Unpacker(const std::string& /*file*/) : stream_(std::make_unique<Stream>()) {
  if (inflateInit(&stream_->state) != Z_OK) throw std::bad_alloc();
}

Unpacker::~Unpacker() {
  inflateEnd(&stream_->state);
}

void Unpacker::begin(std::string_view packed) {
  inflateReset(&stream_->state);
  stream_->packed = packed;
}

std::size_t Unpacker::take(char* to, std::size_t count) {
  constexpr std::size_t kMost = std::size_t{1} << 30;  // zlib counts with 32 bits
  auto& [state, packed, at_end] = *stream_;
  const std::size_t wanted = count;
  at_end = false;
  while (!at_end) {
    const std::size_t given = std::min(packed.size(), kMost);
    state.next_in = const_cast<Bytef*>(reinterpret_cast<const Bytef*>(packed.data()));  // NOLINT: zlib reads only
    state.avail_in = static_cast<uInt>(given);
    state.next_out = reinterpret_cast<Bytef*>(to);
    state.avail_out = static_cast<uInt>(count);
    const int result = ::inflate(&state, Z_NO_FLUSH);
    packed.remove_prefix(given - state.avail_in);
    to += count - state.avail_out;
    count = state.avail_out;
    at_end = result == Z_STREAM_END;
    if (count == 0 || (result != Z_OK && !at_end)) break;
  }
  return wanted - count;
}

bool Unpacker::at_end() const {
  return stream_->at_end && stream_->packed.empty();
}

}  // namespace driftmesh
