#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "base/atomic_file.hpp"
#include "driftmesh/error.hpp"
#include "temporary_folder.hpp"

using namespace driftmesh;
namespace fs = std::filesystem;

namespace {

std::string content(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::size_t files_in(const fs::path& folder) {
  return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

}  // namespace

TEST_CASE("a file appears only when committed, and whole") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "out.txt";
  const std::string large(3 << 20, 'x');
  {
    AtomicFile file(path.string());
    file.write("first ");
    file.write(large);
    CHECK(file.size() == 6 + large.size());
    CHECK_FALSE(fs::exists(path));
    file.commit();
  }
  CHECK(content(path) == "first " + large);
  CHECK(files_in(folder.path()) == 1);
}

TEST_CASE("small and large pieces follow each other in the file, also beyond what the disk begins with") {
  const TemporaryFolder folder;
  const std::string path = (folder.path() / "large").string();
  const std::size_t sizes[] = {3, 700'000, 5, 1 << 20, 400'000, 20 << 20, 1, 9 << 20, 600'000};
  std::string expected;
  AtomicFile file(path);
  for (std::size_t k = 0; k < std::size(sizes); ++k) {
    std::string piece(sizes[k], '\0');
    for (std::size_t i = 0; i < piece.size(); ++i) piece[i] = static_cast<char>(i / 7 + 31 * k);
    file.write(piece);
    expected += piece;
    CHECK(file.size() == expected.size());
  }
  file.commit();
  CHECK((content(path) == expected));
}

TEST_CASE("without commit the old file stays and nothing else is left behind") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "out.txt";
  std::ofstream(path) << "old";
  {
    AtomicFile file(path.string());
    file.write("new");
  }
  CHECK(content(path) == "old");
  CHECK(files_in(folder.path()) == 1);
}

TEST_CASE("a link is followed and stays a link") {
  const TemporaryFolder folder;
  const fs::path real = folder.path() / "real.txt";
  const fs::path link = folder.path() / "link.txt";
  std::ofstream(real) << "old";
  fs::create_symlink(real, link);
  AtomicFile file(link.string());
  file.write("new");
  file.commit();
  CHECK(fs::is_symlink(link));
  CHECK(content(real) == "new");
}

TEST_CASE("errors name the file and the reason") {
  const TemporaryFolder folder;
  const std::string missing = (folder.path() / "no" / "out.txt").string();
  CHECK_THROWS_WITH_AS(AtomicFile{missing}, (missing + ": cannot write: No such file or directory").c_str(), FileError);
  const std::string directory = folder.path().string();
  CHECK_THROWS_WITH_AS(AtomicFile{directory}, (directory + ": cannot write: Is a directory").c_str(), FileError);
}

TEST_CASE("a full disk is noticed, at the latest by commit") {
  if (!fs::exists("/dev/full")) return;
  AtomicFile file("/dev/full");
  file.write("does not fit");
  CHECK_THROWS_WITH_AS(file.commit(), "/dev/full: cannot write: No space left on device", FileError);
  CHECK(fs::is_character_file("/dev/full"));
}
