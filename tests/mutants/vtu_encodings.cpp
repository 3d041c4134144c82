#include "mutants/vtu_encodings.hpp"

#include <zlib.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <vector>

#include "mutants/fields.hpp"

namespace driftmesh::mutants {
namespace {

constexpr std::size_t kBlock = 64;

std::string length(std::uint64_t value) {
  std::string bytes(8, '\0');
  std::memcpy(bytes.data(), &value, 8);
  return bytes;
}

std::string deflated(const std::string& bytes) {
  uLongf size = ::compressBound(bytes.size());
  std::string packed(size, '\0');
  ::compress(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()),
             bytes.size());
  packed.resize(size);
  return packed;
}

/// In base64 the lengths of compressed blocks are encoded by themselves.
std::string stored(const std::string& bytes, const VtuEncoding& encoding) {
  const auto encoded = [&](const std::string& text) { return encoding.base64 ? to_base64(text) : text; };
  if (!encoding.compressed) return encoded(length(bytes.size()) + bytes);
  std::string sizes, packed;
  for (std::size_t i = 0; i < bytes.size(); i += kBlock) {
    const std::string block = deflated(bytes.substr(i, kBlock));
    sizes += length(block.size());
    packed += block;
  }
  return encoded(length(sizes.size() / 8) + length(kBlock) + length(bytes.size() % kBlock) + sizes) + encoded(packed);
}

void replace(std::string& text, const std::string& from, const std::string& to) {
  const std::size_t found = text.find(from);
  if (found != std::string::npos) text.replace(found, from.size(), to);
}

}  // namespace

std::string vtu_as(const std::string& raw, const VtuEncoding& encoding) {
  const std::size_t begin = raw.find('_', raw.find("<AppendedData")) + 1;
  std::string header = raw.substr(0, begin), data;
  std::size_t end = begin;
  for (std::size_t at = 0; (at = header.find("offset=\"", at)) != std::string::npos; ++at) {
    const std::size_t digits = at + 8, quote = header.find('"', digits);
    const std::size_t place = begin + std::stoull(header.substr(digits, quote - digits));
    std::uint64_t size = 0;
    std::memcpy(&size, raw.data() + place, 8);
    header.replace(digits, quote - digits, std::to_string(data.size()));
    data += stored(raw.substr(place + 8, size), encoding);
    end = std::max(end, place + 8 + size);
  }
  if (encoding.compressed) replace(header, "header_type", "compressor=\"vtkZLibDataCompressor\" header_type");
  if (encoding.base64) replace(header, "encoding=\"raw\"", "encoding=\"base64\"");
  return header + data + raw.substr(end);
}

}  // namespace driftmesh::mutants
