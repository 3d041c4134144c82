#include <doctest/doctest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <string>

#include "base/atomic_file.hpp"
#include "base/staged_files.hpp"
#include "base/temporary_files.hpp"
#include "driftmesh/error.hpp"
#include "temporary_folder.hpp"

using namespace driftmesh;
namespace fs = std::filesystem;

namespace {

struct StagingFolder {
  TemporaryFolder folder;
  [[nodiscard]] std::string operator/(const std::string& name) const { return (folder.path() / name).string(); }
  void put(const std::string& name, const std::string& text) const { std::ofstream(*this / name) << text; }
  [[nodiscard]] std::string content(const std::string& name) const {
    std::ifstream in(*this / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  [[nodiscard]] std::set<std::string> names() const {
    std::set<std::string> all;
    for (const auto& entry : fs::directory_iterator(folder.path())) all.insert(entry.path().filename().string());
    return all;
  }
};

void write(const std::string& path, const std::string& text) {
  AtomicFile file(path);
  file.write(text);
  file.commit();
}

}  // namespace

TEST_CASE("staged files appear on commit, or not at all") {
  const StagingFolder at;
  at.put("a", "old");
  {
    const StagedFiles files;
    write(at / "a", "new");
    write(at / "b", "new");
    CHECK(at.content("a") == "old");
    CHECK(at.names().size() == 3);  // two of them temporary
    REQUIRE(files.files().size() == 2);
    CHECK(files.files()[1].path == at / "b");
    CHECK(files.files()[1].bytes == 3);
  }
  CHECK(at.content("a") == "old");
  CHECK(at.names() == std::set<std::string>{"a"});
  StagedFiles files;
  write(at / "a", "new");
  write(at / "b", "newer");
  files.commit();
  CHECK(at.content("a") == "new");
  CHECK(at.content("b") == "newer");
  CHECK(at.names() == std::set<std::string>{"a", "b"});
}

TEST_CASE("files that have appeared are removed if a later one fails") {
  const StagingFolder at;
  at.put("a", "old");
  StagedFiles files;
  for (const char* name : {"a", "b", "c"}) write(at / name, "new");
  fs::create_directory(at / "c");
  at.put("c/file", "");
  CHECK_THROWS_AS(files.commit(), FileError);
  CHECK(at.content("a") == "old");
  CHECK(at.names() == std::set<std::string>{"a", "c"});
}

TEST_CASE("files that have appeared are removed unless all are finished") {
  const StagingFolder at;
  at.put("a", "old");
  {
    StagedFiles files;
    write(at / "a", "new");
    write(at / "b", "new");
    files.appear();
    CHECK(at.content("a") == "new");
    CHECK(at.content("b") == "new");
  }
  CHECK(at.content("a") == "old");
  CHECK(at.names() == std::set<std::string>{"a"});
}

TEST_CASE("commits of an inner stage wait for the outer one") {
  const StagingFolder at;
  StagedFiles outer;
  {
    StagedFiles inner;
    write(at / "kept", "new");
    inner.commit();
  }
  {
    const StagedFiles inner;
    write(at / "dropped", "new");
  }
  CHECK_FALSE(fs::exists(at / "kept"));
  outer.commit();
  CHECK(at.names() == std::set<std::string>{"kept"});
}

TEST_CASE("a name that is staged twice gets the later file, or keeps the first one") {
  const StagingFolder at;
  at.put("a", "old");
  for (const bool finishes : {false, true}) {
    StagedFiles files;
    write(at / "a", "first");
    write(at / "a", "second");
    files.appear();
    CHECK(at.content("a") == "second");
    if (finishes) files.finish();
  }
  CHECK(at.content("a") == "second");
  CHECK(at.names() == std::set<std::string>{"a"});
}

TEST_CASE("remains of dead processes are removed, and nothing else") {
  const pid_t child = ::fork();
  if (child == 0) ::_exit(0);
  ::waitpid(child, nullptr, 0);
  const StagingFolder at;
  const std::string own = fs::path(temporary_name(at / "a")).filename().string();
  const std::string process = "-" + std::to_string(::getpid()) + "-";
  const std::size_t place = own.rfind(process);
  REQUIRE(place != std::string::npos);
  const std::string head = own.substr(0, place) + "-", tail = own.substr(place + process.size() - 1);
  const std::string dead = head + std::to_string(child) + tail;
  const std::set<std::string> others = {own,
                                        head + "1" + tail,
                                        dead + "x",
                                        "x" + dead + ".old",
                                        head + tail,
                                        head + std::to_string(child),
                                        "a.tmp-host-" + std::to_string(child) + "-0"};
  for (const std::string& name : others) at.put(name, "");
  at.put(dead, "");
  remove_remains_beside(at / "a");
  CHECK(at.names() == others);
}

TEST_CASE("held signals wait") {
  const StagingFolder at;
  at.put("temporary", "");
  const pid_t child = ::fork();
  if (child == 0) {
    std::signal(SIGTERM, SIG_DFL);
    remove_temporaries_on_signals();
    const NotedTemporary noted(at / "temporary");
    {
      const HeldSignals held;
      {
        const HeldSignals more;
        ::raise(SIGTERM);
      }
      std::ofstream(at / "survived") << "yes";
    }
    ::_exit(0);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  CHECK(WIFSIGNALED(status));
  CHECK(WTERMSIG(status) == SIGTERM);
  CHECK(at.names() == std::set<std::string>{"survived"});
}
