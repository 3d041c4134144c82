#include "distributed/parts_file.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <exception>
#include <fstream>
#include <iterator>
#include <map>
#include <numeric>
#include <string>
#include <vector>

#include "driftmesh/driftmesh.hpp"
#include "driftmesh/error.hpp"
#include "io/hdf5_bytes.hpp"
#include "support/error_text.hpp"
#include "temporary_folder.hpp"

using namespace driftmesh;
using testing::error_text;
using testing::mentions;

namespace {

Bytes bytes_of(const std::string& text) {
  const auto* const begin = reinterpret_cast<const std::byte*>(text.data());
  return {begin, begin + text.size()};
}

const std::vector<std::string> kParts{"one", "", "three of them"};

void write(const std::string& path, const PartsFormat& format = kCheckpointFile) {
  OneRank one;
  std::map<SubdomainId, std::uint64_t> sizes;
  for (std::size_t i = 0; i < kParts.size(); ++i) sizes[static_cast<SubdomainId>(i)] = kParts[i].size();
  write_parts(
      path, format, {{format.head, bytes_of("head")}, {"more", bytes_of("")}}, kParts.size(), sizes,
      [&](SubdomainId s) { return bytes_of(kParts[to_index(s)]); }, one);
}

/// Reads all of it.
std::string error_of(const std::string& path) {
  return error_text([&] {
    const PartsFile file(path, kCheckpointFile);
    (void)file.head(kCheckpointFile.head);
    (void)file.head("more");
    for (std::size_t i = 0; i < file.ends().size(); ++i) (void)file.part(static_cast<SubdomainId>(i));
  });
}

}  // namespace

TEST_CASE("parts and heads come back as they were written") {
  const TemporaryFolder folder;
  const std::string path = (folder.path() / "run.kept").string();
  write(path);
  const PartsFile file(path, kCheckpointFile);
  CHECK(file.head(kCheckpointFile.head) == bytes_of("head"));
  CHECK(file.head("more").empty());
  REQUIRE(file.ends().size() == kParts.size());
  for (std::size_t i = 0; i < kParts.size(); ++i) CHECK(file.part(static_cast<SubdomainId>(i)) == bytes_of(kParts[i]));
}

TEST_CASE("a file of another kind or version is refused by name") {
  const TemporaryFolder folder;
  const auto named = [&](const char* name) { return (folder.path() / name).string(); };
  write(named("session"), kAdaptiveMeshFile);
  CHECK(mentions(error_of(named("session")), {"session", "is an adaptive mesh, not a checkpoint", "AdaptiveMesh"}));
  (void)create_hdf5_bytes(named("later"), "later", 7, {{kCheckpointFile.head, 8}});
  CHECK(mentions(error_of(named("later")), {"later", "a checkpoint of version 7", "reads version 1"}));
  (void)create_hdf5_bytes(named("foreign"), "foreign", 1, {{"other", 8}});
  CHECK(mentions(error_of(named("foreign")), {"foreign", "has no array"}));
  write_mesh(mesh(generate("rectangle-hole"), {.max_area = 0.1}), named("mesh.h5"));
  CHECK(
      mentions(error_of(named("mesh.h5")), {"is a mesh alone, not a checkpoint", "driftmesh mesh --checkpoint wrote"}));
  CHECK(!is_parts_file(named("mesh.h5"), kCheckpointFile));
  std::ofstream(named("text")) << "none";
  CHECK(mentions(error_of(named("text")), {"text", "is not an HDF5 file"}));
  CHECK(mentions(error_of(named("none")), "none"));
}

TEST_CASE("damage is found wherever it matters, and so is a cut") {
  const TemporaryFolder folder;
  const std::string path = (folder.path() / "run.kept").string(), other = (folder.path() / "bad.kept").string();
  write(path);
  CHECK(error_of(path) == "no error");
  std::ifstream file(path, std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(file)), {});
  for (const std::string& text : {kParts.front(), kParts.back(), std::string("head")}) {
    std::string damaged = bytes;
    const std::size_t place = damaged.rfind(text);
    REQUIRE(place != std::string::npos);
    damaged[place] ^= 0x10;
    std::ofstream(other, std::ios::binary) << damaged;
    CHECK(mentions(error_of(other), "bad.kept"));
  }
  for (std::size_t part = 0; part < 20; ++part) {
    std::ofstream(other, std::ios::binary) << bytes.substr(0, bytes.size() * part / 20);
    CHECK(mentions(error_of(other), "bad.kept"));
  }
}

TEST_CASE("what cannot be written leaves what was there") {
  const TemporaryFolder folder;
  const std::string path = (folder.path() / "run.kept").string();
  write(path);
  OneRank one;
  const auto size = [](SubdomainId) { return std::uint64_t{3}; };
  CHECK(mentions(error_text([&] {
                   write_parts(
                       path, kCheckpointFile, {{kCheckpointFile.head, {}}}, 1, {{SubdomainId{0}, size(SubdomainId{0})}},
                       [](SubdomainId) { return bytes_of("four"); }, one);
                 }),
                 "changes while it is saved"));
  CHECK(error_of(path) == "no error");
  CHECK(std::distance(std::filesystem::directory_iterator(folder.path()), {}) == 1);
}

TEST_CASE("ranks share parts by what they weigh") {
  CHECK(shares_of({1, 2, 3, 4}, 2) == std::vector<std::size_t>{0, 2, 4});
  CHECK(shares_of({10, 11, 12, 20}, 2) == std::vector<std::size_t>{0, 1, 4});
  CHECK(shares_of({1, 2}, 5).size() == 6);
  CHECK(shares_of({1, 2}, 5).back() == 2);
  CHECK(shares_of({}, 3) == std::vector<std::size_t>{0, 0, 0, 0});
}
