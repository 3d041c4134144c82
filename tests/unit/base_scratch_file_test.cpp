#include <doctest/doctest.h>
#include <sys/stat.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <random>
#include <string>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "base/bytes.hpp"
#include "base/mapped_array.hpp"
#include "base/scratch_file.hpp"
#include "driftmesh/error.hpp"
#include "temporary_folder.hpp"

using namespace driftmesh;

namespace {

Bytes noise(std::size_t size, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  Bytes bytes(size);
  std::generate(bytes.begin(), bytes.end(), [&] { return static_cast<std::byte>(random()); });
  return bytes;
}

Bytes read_all(const ScratchFile::Piece& piece) {
  Bytes bytes(piece.bytes());
  piece.read(0, bytes);
  return bytes;
}

/// Bytes on disk of the files without a name that this process has open in a folder: what others do there does not
/// matter.
std::uint64_t room_taken_in(const std::filesystem::path& folder) {
  std::uint64_t bytes = 0;
  for (const auto& descriptor : std::filesystem::directory_iterator("/proc/self/fd")) {
    std::error_code gone;  // the descriptor of this loop itself, when it ends
    const std::string target = std::filesystem::read_symlink(descriptor, gone).string();
    struct stat status {};
    if (target.starts_with(folder.string() + "/") && ::stat(descriptor.path().c_str(), &status) == 0)
      bytes += static_cast<std::uint64_t>(status.st_blocks) * 512;
  }
  return bytes;
}

}  // namespace

TEST_CASE("a scratch file gives back what was put there, and no name of it is seen") {
  const TemporaryFolder folder;
  ScratchFile file(folder.path().string());
  std::vector<std::pair<ScratchFile::Piece, Bytes>> kept;
  for (std::uint64_t i = 0; i < 50; ++i) {
    const Bytes bytes = noise(i * 997, i);
    const auto front = std::span(bytes).first(bytes.size() / 3);
    kept.emplace_back(file.put({front, std::span(bytes).subspan(front.size())}), bytes);
    if (i % 4 == 3) kept.erase(kept.begin());  // its room is used again, and no other bytes change
  }
  CHECK(std::filesystem::is_empty(folder.path()));
  for (const auto& [piece, bytes] : kept) CHECK(read_all(piece) == bytes);
  Bytes tail(100);
  kept.back().first.read(kept.back().second.size() - 100, tail);
  CHECK(std::equal(tail.begin(), tail.end(), kept.back().second.end() - 100));
}

TEST_CASE("room in a scratch file that is no longer needed is given back") {
  const TemporaryFolder folder;
  ScratchFile file(folder.path().string());
  const Bytes megabytes = noise(std::size_t{32} << 20, 1);
  std::optional piece = file.put({megabytes});
  CHECK(room_taken_in(folder.path()) >= megabytes.size());
  piece.reset();
  CHECK(room_taken_in(folder.path()) < megabytes.size() / 100);
}

TEST_CASE("pieces may outlive what is in a discarded scratch file") {
  const TemporaryFolder folder;
  ScratchFile file(folder.path().string());
  const Bytes megabytes = noise(std::size_t{32} << 20, 1);
  {
    const ScratchFile::Piece piece = file.put({megabytes});
    CHECK(room_taken_in(folder.path()) >= megabytes.size());
    file.discard();
  }
  CHECK(room_taken_in(folder.path()) == 0);
}

TEST_CASE("the room of a scratch file is that of its file system") {
  const TemporaryFolder folder;
  const std::uint64_t all = std::filesystem::space(folder.path()).capacity;
  CHECK(ScratchFile(folder.path().string()).room() <= all);
}

TEST_CASE("threads may use one scratch file") {
  const TemporaryFolder folder;
  ScratchFile file(folder.path().string());
  std::vector<std::thread> threads;
  std::vector<int> wrong(4, 0);
  for (std::size_t t = 0; t < wrong.size(); ++t)
    threads.emplace_back([&, t] {
      for (std::uint64_t i = 0; i < 200; ++i) {
        const Bytes bytes = noise(1000 + i, 1000 * t + i);
        const ScratchFile::Piece piece = file.put({bytes});
        if (read_all(piece) != bytes) ++wrong[t];
      }
    });
  for (std::thread& thread : threads) thread.join();
  CHECK(wrong == std::vector<int>(4, 0));
}

TEST_CASE("a folder that cannot be written is refused by name") {
  const TemporaryFolder folder;
  const std::string missing = (folder.path() / "missing").string();
  CHECK_THROWS_WITH_AS(ScratchFile{missing},
                       (missing + ": cannot keep scratch data in this folder: No such file or directory").c_str(),
                       FileError);
}

TEST_CASE("large arrays lie in the folder for temporary files, or are refused where there is none") {
  constexpr std::uint64_t kLarge = std::uint64_t{40} << 20;  // 8 bytes each: more than memory is used for
  const TemporaryFolder folder;
  const char* const before = std::getenv("TMPDIR");
  const std::string kept = before != nullptr ? before : "/tmp";
  ::setenv("TMPDIR", folder.path().c_str(), 1);
  {
    MappedArray<double> array(kLarge);
    CHECK(array[0] == 0);
    CHECK(array[kLarge - 1] == 0);
    array[kLarge - 1] = 7;
    MappedArray<double> moved = std::move(array);
    CHECK(moved[kLarge - 1] == 7);
    CHECK(moved.size() == kLarge);
    CHECK(std::filesystem::is_empty(folder.path()));
  }
  ::setenv("TMPDIR", (folder.path() / "none").c_str(), 1);
  CHECK_THROWS_AS(MappedArray<double>(std::uint64_t{1} << 26), FileError);
  MappedArray<std::int32_t> small(1000);
  small[999] = 3;
  CHECK(small[999] + small[0] == 3);
  ::setenv("TMPDIR", kept.c_str(), 1);
}
