#pragma once

#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <random>
#include <string>

#include "driftmesh/error.hpp"

namespace driftmesh::test {

inline std::string file_bytes(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

inline void replace_file(const std::string& path, const std::string& bytes) {
  std::filesystem::remove(path);  // some file systems write a truncated file out at once, which takes long
  std::ofstream stream(path, std::ios::binary);
  stream << bytes;
}

/// The numbers of damaged versions of a file that a reader accepted, and rejected with driftmesh::Error. Any other
/// outcome fails the test by itself.
struct DamageCount {
  int accepted = 0;
  int refused = 0;
};

inline void read_damaged(const std::string& path, const std::string& bytes, const std::function<void()>& read,
                         DamageCount& count) {
  replace_file(path, bytes);
  try {
    read();
    ++count.accepted;
  } catch (const Error& error) {
    CHECK(std::string(error.what()).size() > 10);
    ++count.refused;
  }
}

/// The file cut off after every number of bytes less than its size.
inline DamageCount read_truncated(const std::string& path, const std::function<void()>& read) {
  const std::string whole = file_bytes(path);
  DamageCount count;
  for (std::size_t size = 0; size < whole.size(); ++size) read_damaged(path, whole.substr(0, size), read, count);
  replace_file(path, whole);
  return count;
}

/// Calls visit(bytes) with every byte changed in turn, and `rounds` times with several random bytes changed.
template <class Visit>
void for_each_flipped(const std::string& whole, int rounds, std::uint32_t seed, const Visit& visit) {
  std::mt19937 random(seed);
  const auto flip = [&](std::string& bytes, std::size_t at) {
    bytes[at] = static_cast<char>(bytes[at] ^ static_cast<char>(1 + random() % 255));
  };
  for (std::size_t at = 0; at < whole.size(); ++at) {
    std::string bytes = whole;
    flip(bytes, at);
    visit(bytes);
  }
  for (int round = 0; round < rounds; ++round) {
    std::string bytes = whole;
    for (std::size_t flips = 2 + random() % 8; flips > 0; --flips) flip(bytes, random() % bytes.size());
    visit(bytes);
  }
}

/// The file changed like that.
inline DamageCount read_flipped(const std::string& path, int rounds, std::uint32_t seed,
                                const std::function<void()>& read) {
  const std::string whole = file_bytes(path);
  DamageCount count;
  for_each_flipped(whole, rounds, seed, [&](const std::string& bytes) { read_damaged(path, bytes, read, count); });
  replace_file(path, whole);
  return count;
}

}  // namespace driftmesh::test
