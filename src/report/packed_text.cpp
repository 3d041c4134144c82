#include "report/packed_text.hpp"

#include <zlib.h>

#include <cstdint>
#include <new>
#include <vector>

namespace driftmesh {

std::string packed_text(const void* bytes, std::size_t count) {
  std::vector<unsigned char> packed(compressBound(count));
  uLongf size = packed.size();
  if (compress2(packed.data(), &size, static_cast<const Bytef*>(bytes), count, Z_DEFAULT_COMPRESSION) != Z_OK)
    throw std::bad_alloc();  // the only reason that is left
  packed.resize(size);
  packed.resize((size + 2) / 3 * 3, 0);
  constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve(packed.size() / 3 * 4);
  for (std::size_t i = 0; i < packed.size(); i += 3) {
    const std::uint32_t three = static_cast<std::uint32_t>(packed[i] << 16 | packed[i + 1] << 8 | packed[i + 2]);
    for (const int shift : {18, 12, 6, 0}) text += kDigits[three >> shift & 63];
  }
  for (std::size_t i = 0; i < packed.size() - size; ++i) text[text.size() - 1 - i] = '=';
  return text;
}

}  // namespace driftmesh
