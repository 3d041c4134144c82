#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "base/file_identity.hpp"
#include "base/file_registry.hpp"
#include "driftmesh/error.hpp"
#include "temporary_folder.hpp"

using namespace driftmesh;
namespace fs = std::filesystem;

namespace {

struct Folder {
  TemporaryFolder folder;
  [[nodiscard]] std::string operator/(const char* name) const { return (folder.path() / name).string(); }
  void touch(const char* name) const { std::ofstream(*this / name) << "text"; }
};

std::string refusal(const auto& work) {
  try {
    work();
  } catch (const InputError& error) {
    return error.what();
  }
  return "none";
}

}  // namespace

TEST_CASE("names of one file have one identity") {
  const Folder at;
  at.touch("file");
  fs::create_directory(at / "sub");
  fs::create_symlink("sub", at / "there");
  fs::create_symlink("file", at / "soft");
  fs::create_hard_link(at / "file", at / "hard");
  for (const char* name : {"./file", "sub/../file", "there/../file", "soft", "hard"})
    CHECK(identity_of(at / name) == identity_of(at / "file"));
  CHECK_FALSE(identity_of(at / "sub") == identity_of(at / "file"));
}

TEST_CASE("files that do not exist yet have one, too") {
  const Folder at;
  fs::create_directory(at / "sub");
  fs::create_symlink("sub", at / "there");
  fs::create_symlink("sub/new", at / "dangling");
  fs::create_symlink("dangling", at / "twice");
  for (const char* name : {"there/new", "sub/./new", "dangling", "twice"})
    CHECK(identity_of(at / name) == identity_of(at / "sub/new"));
  CHECK_FALSE(identity_of(at / "new") == identity_of(at / "sub/new"));
  CHECK(identity_of(at / "no/x/../new") == identity_of(at / "no/new"));
  fs::create_symlink("circle", at / "circle");
  CHECK(link_target(at / "circle") == at / "circle");
}

TEST_CASE("what is read is not written, in whichever order it is registered") {
  const Folder at;
  at.touch("in");
  fs::create_hard_link(at / "in", at / "out");
  const std::string both = (at / "out") + ": --output would overwrite it, and --input (there called " + (at / "in") +
                           ") reads it; give the output another name";
  FileRegistry reads_first;
  reads_first.reads(at / "in", "--input");
  CHECK(refusal([&] { reads_first.writes(at / "out", "--output"); }) == both);
  FileRegistry writes_first;
  writes_first.writes(at / "out", "--output");
  CHECK(refusal([&] { writes_first.reads(at / "in", "--input"); }) == both);
}

TEST_CASE("a file is written once, and may be read often") {
  const Folder at;
  at.touch("in");
  FileRegistry files;
  files.reads(at / "in", "--input");
  files.reads(at / "in", "--size-mesh");
  files.writes(at / "a", "--output");
  CHECK(refusal([&] { files.writes(at / "./a", "--output"); }).find("--output would write it twice") !=
        std::string::npos);
  CHECK(refusal([&] { files.writes(at / "a", "--json"); }) ==
        (at / "a") + ": --json and --output would both write it; give each output a name of its own");
  files.writes(at / "b", "--json");
}

TEST_CASE("standard input is read once and standard output written once") {
  FileRegistry files;
  files.reads("-", "INPUT");
  files.writes("-.msh", "--output");
  CHECK(refusal([&] { files.reads("-.poly", "--config"); }).find("INPUT and --config") != std::string::npos);
  CHECK(refusal([&] { files.writes("-", "--json"); }).find("--json and --output (there called -.msh)") !=
        std::string::npos);
}

TEST_CASE("a device may have any number of uses") {
  FileRegistry files;
  for (const char* use : {"--json", "--output"}) {
    files.reads("/dev/null", use);
    files.writes("/dev/null", use);
  }
}
