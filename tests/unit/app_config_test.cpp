#include <doctest/doctest.h>

#include <fstream>

#include "app/config_file.hpp"
#include "app/mesh_options.hpp"
#include "base/error.hpp"
#include "cli/command_line.hpp"
#include "temporary_folder.hpp"

using namespace driftmesh;
using namespace driftmesh::app;

namespace {

/// The number that --max-memory makes of it, or 0 where it refuses.
std::uint64_t memory_of(const std::string& text) {
  MeshOptions options;
  const cli::Command command{.name = "mesh", .options = mesh_options(options)};
  cli::Call call;
  try {
    cli::parse(command, {"--max-memory=" + text}, call);
  } catch (const cli::UsageError&) {
    return 0;
  }
  return options.max_memory;
}

/// The options of `driftmesh mesh ARGUMENTS` with a settings file of this text.
class Parsed {
 public:
  Parsed(const std::vector<std::string>& arguments, const std::string& yaml)
      : file_((folder_.path() / "run.yaml").string()) {
    std::ofstream(file_) << yaml;
    cli::parse(command_, arguments, call_);
    apply_config(call_, file_);
  }
  [[nodiscard]] std::string command_line() const { return call_.text({"config", "quiet"}); }

  MeshOptions options;

 private:
  TemporaryFolder folder_;
  std::string file_;
  cli::Command command_{.name = "driftmesh mesh", .options = mesh_options(options)};
  cli::Call call_;
};

/// The message for a settings file, from its place on.
std::string message_for(const std::string& yaml) {
  try {
    const Parsed parsed({"in.poly"}, yaml);
  } catch (const InputError& error) {
    const std::string message = error.what();
    return message.substr(message.find("run.yaml"));
  }
  return "no error";
}

}  // namespace

TEST_CASE("A settings file sets what the command line left out") {
  const Parsed parsed({"-a", "7", "--angle", "25"},
                      "input: bay.poly  # comment\narea: 5000\nsize: 1 + x\noutput: [a.vtu, b.msh]\n"
                      "max-triangles: 2M\nmax-memory: 1G\ngradation: 0.25\nkeep-incomplete: true\nquiet: false\n");
  CHECK(parsed.options.input == "bay.poly");
  CHECK(parsed.options.area == 7);
  CHECK(parsed.options.angle == 25);
  CHECK(parsed.options.sizing.expression == "1 + x");
  CHECK(parsed.options.sizing.gradation == 0.25);
  CHECK(parsed.options.outputs == std::vector<std::string>{"a.vtu", "b.msh"});
  CHECK(parsed.options.max_triangles == 2'000'000);
  CHECK(parsed.options.max_memory == std::uint64_t{1} << 30);
  CHECK(parsed.options.keep_incomplete);
  CHECK_FALSE(parsed.options.quiet);
}

TEST_CASE("The command line that repeats a run says what the settings file said") {
  const Parsed parsed({"my bay.poly", "-o", "a.vtu"}, "size: it's\nangle: 30\nno-region-areas: true\nquiet: true\n");
  CHECK(parsed.command_line() ==
        "driftmesh mesh 'my bay.poly' --output a.vtu --size 'it'\\''s' --angle 30 --no-region-areas");
}

TEST_CASE("An empty settings file sets nothing") {
  CHECK(message_for("") == "no error");
  CHECK(message_for("# nothing\n") == "no error");
}

TEST_CASE("Errors in a settings file name the place and what to do") {
  CHECK(message_for("area: 3\n  anlge: 20\n").starts_with("run.yaml:2:"));
  CHECK(message_for("area: 3\nanlge: 20\n") == "run.yaml:2:1: unknown option 'anlge'; the nearest one is 'angle'");
  CHECK(message_for("max_triangles: 3\n") ==
        "run.yaml:1:1: unknown option 'max_triangles'; the nearest one is 'max-triangles'");
  CHECK(message_for("config: a.yaml\n").starts_with("run.yaml:1:1: unknown option 'config'"));
  CHECK(message_for("area: 3\narea: 4\n") == "run.yaml:2:1: 'area' is given twice; remove one of them");
  CHECK(message_for("angle: 50\n").starts_with("run.yaml:1:8: --angle: '50' is not an angle from 0 to 34 degrees"));
  CHECK(message_for("area: [1, 2]\n").starts_with("run.yaml:1:7: "));
  CHECK(message_for("area:\n").starts_with("run.yaml:1:"));
  CHECK(message_for("area: {a: 1}\n").starts_with("run.yaml:1:7: 'area' has no value that can be used"));
  CHECK(message_for("quiet: maybe\n").starts_with("run.yaml:1:8: 'quiet' is maybe"));
  CHECK(message_for("- area\n").starts_with("run.yaml:1:1: "));
  CHECK(message_for("area: [1\n").starts_with("run.yaml:"));
}

TEST_CASE("Sizes have units") {
  CHECK(memory_of("1") == 1);
  CHECK(memory_of("2e6") == 2'000'000);
  CHECK(memory_of("1.5k") == 1536);
  CHECK(memory_of("3M") == 3 << 20);
  CHECK(memory_of("6GiB") == std::uint64_t{6} << 30);
  CHECK(memory_of("1tb") == std::uint64_t{1} << 40);
  for (const std::string bad : {"", "0", "-1", "-1G", "much", "1X", "1 GG", "G", "nan", "1e30", "1.2.3"})
    CHECK_MESSAGE(memory_of(bad) == 0, bad);
}
