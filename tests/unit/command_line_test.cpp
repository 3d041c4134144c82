#include "cli/command_line.hpp"

#include <doctest/doctest.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cli/help_text.hpp"
#include "cli/values.hpp"

using namespace driftmesh;
using namespace driftmesh::cli;

namespace {

/// A program with two commands, and the values it received.
struct Program {
  std::string input, order = "given", switches;
  std::vector<std::string> outputs;
  double area = 0;
  int count = 0;
  bool quiet = false, fast = false;
  std::vector<double> speeds;
  Call call;
  Command root{
      .name = "prog",
      .summary = "A program",
      .options =
          {{.kind = Option::Kind::kFlag, .name = "version", .help = "Its version", .prints = [] { return "7\n"; }}},
      .commands = {
          {.name = "mesh",
           .summary = "Make a mesh",
           .options = {{.kind = Option::Kind::kPositional,
                        .name = "input",
                        .value = "INPUT",
                        .help = "The input",
                        .required = true,
                        .take = into(input)},
                       {.name = "area",
                        .letter = 'a',
                        .value = "AREA",
                        .help = "No triangle is larger than this",
                        .group = "Triangles",
                        .take = into(area, kPositive)},
                       {.name = "count", .letter = 'n', .value = "N", .take = into(count, {1, 9})},
                       {.name = "output", .letter = 'o', .value = "FILE", .repeats = true, .take = into(outputs)},
                       {.name = "order",
                        .value = "ORDER",
                        .help = "Which comes next",
                        .standard = "given",
                        .choices = {"given", "largest", "backlog"},
                        .take = into(order)},
                       {.name = "speeds", .value = "S,S,...", .take = into(speeds, kPositive)},
                       {.kind = Option::Kind::kFlag, .name = "quiet", .letter = 'q', .take = into(quiet)},
                       {.kind = Option::Kind::kFlag, .name = "fast", .letter = 'f', .take = into(fast)}}},
          {.name = "old",
           .summary = "A command with switches of its own",
           .options = {{.kind = Option::Kind::kPositional, .name = "input", .value = "INPUT", .take = into(input)},
                       {.name = "order", .value = "ORDER", .take = into(order)}},
           .take_switches = [this](const std::string& word) { switches += word; }},
          {.name = "generate", .summary = "Make an input", .commands = {{.name = "bay"}, {.name = "comb"}}}}};

  void read(const std::vector<std::string>& words) { parse(root, words, call); }
};

std::string problem(const std::vector<std::string>& words) {
  Program program;
  try {
    program.read(words);
  } catch (const UsageError& error) {
    return error.what();
  }
  return "none";
}

}  // namespace

TEST_CASE("Options have a long name and a letter, and mix with arguments") {
  Program p;
  p.read({"mesh", "--area=2.5", "-n3", "in.poly", "-o", "a.vtu", "--output", "b.vtu", "-qf", "--speeds", "1,2.5"});
  CHECK(p.call.name == "prog mesh");
  CHECK(p.input == "in.poly");
  CHECK(p.area == 2.5);
  CHECK(p.count == 3);
  CHECK(p.outputs == std::vector<std::string>{"a.vtu", "b.vtu"});
  CHECK(p.quiet);
  CHECK(p.fast);
  CHECK(p.speeds == std::vector<double>{1, 2.5});
}

TEST_CASE("The last of the flags that share a dash may have a value") {
  Program p;
  p.read({"mesh", "in.poly", "-qa", "4"});
  CHECK(p.quiet);
  CHECK(p.area == 4);
}

TEST_CASE("A value may begin with a dash, and be empty") {
  Program p;
  p.read({"mesh", "-o", "-n", "--output=", "--", "-strange"});
  CHECK(p.outputs == std::vector<std::string>{"-n", ""});
  CHECK(p.input == "-strange");
}

TEST_CASE("Standard streams are arguments") {
  for (const std::string stream : {"-", "-.msh"}) {
    Program p;
    p.read({"mesh", "-o", stream, stream});
    CHECK(p.input == stream);
    CHECK(p.outputs == std::vector<std::string>{stream});
  }
}

TEST_CASE("Commands can have subcommands") {
  Program p;
  p.read({"generate", "comb"});
  CHECK(p.call.name == "prog generate comb");
}

TEST_CASE("Errors suggest what was probably meant") {
  CHECK(problem({}) == "a command is missing: mesh, old or generate");
  CHECK(problem({"mseh"}) == "unknown command 'mseh' (did you mean mesh?)");
  CHECK(problem({"merge"}) == "unknown command 'merge'");
  CHECK(problem({"generate", "by"}) == "unknown command 'by' (did you mean bay?)");
  CHECK(problem({"generate"}) == "a command is missing: bay or comb");
  CHECK(problem({"mesh", "in.poly", "--are", "5"}) == "unknown option --are (did you mean --area?)");
  CHECK(problem({"mesh", "in.poly", "--aera=5"}) == "unknown option --aera (did you mean --area?)");
  CHECK(problem({"mesh", "in.poly", "--such"}) == "unknown option --such");
  CHECK(problem({"mesh", "in.poly", "-x"}) == "unknown option -x");
  CHECK(problem({"mesh", "in.poly", "more"}) == "unexpected argument 'more'");
  const std::string after_dashes = ": after --, every word is the name of a file; options go before --";
  CHECK(problem({"mesh", "--", "in.poly", "--quiet"}) == "unexpected argument '--quiet'" + after_dashes);
  CHECK(problem({"mesh", "in.poly", "--", "-q"}) == "unexpected argument '-q'" + after_dashes);
  CHECK(problem({"mesh", "--quite", "--", "in.poly"}) == "unknown option --quite (did you mean --quiet?)");
  CHECK(problem({"mesh", "--", "in.poly", "more"}) == "unexpected argument 'more'");
  CHECK(problem({"mesh", "in.poly", "--", "more"}) == "unexpected argument 'more'");
  CHECK(problem({"mesh"}) == "INPUT is missing");
  CHECK(problem({"mesh", "in.poly", "--area"}) == "--area needs a value: AREA");
  CHECK(problem({"mesh", "in.poly", "-a"}) == "--area needs a value: AREA");
  CHECK(problem({"mesh", "in.poly", "--quiet=yes"}) == "--quiet takes no value");
  CHECK(problem({"mesh", "in.poly", "-a", "1", "-a", "2"}) == "--area is given twice");
  CHECK(problem({"mesh", "in.poly", "--order", "bakclog"}) ==
        "--order is 'bakclog'; it must be given, largest or backlog (did you mean backlog?)");
}

TEST_CASE("Numbers are complete and in range") {
  CHECK(problem({"mesh", "i", "--area", "5x"}) == "--area is '5x', which is not a number");
  CHECK(problem({"mesh", "i", "--area", ""}) == "--area is '', which is not a number");
  CHECK(problem({"mesh", "i", "--area", "nan"}) == "--area is 'nan', which is not a number");
  CHECK(problem({"mesh", "i", "--area", "1e999"}) == "--area is '1e999', which is not a number");
  CHECK(problem({"mesh", "i", "--area", "0"}) == "--area is 0; it must be above 0");
  CHECK(problem({"mesh", "i", "--area", "+1e-3"}) == "none");
  CHECK(problem({"mesh", "i", "-n", "2.5"}) == "--count is '2.5', which is not a whole number");
  CHECK(problem({"mesh", "i", "-n", "10"}) == "--count is 10; it must be from 1 to 9");
  CHECK(problem({"mesh", "i", "-n", "9999999999999999999"}) ==
        "--count is 9999999999999999999; it must be from 1 to 9");
  CHECK(problem({"mesh", "i", "--speeds", "1,0"}) == "--speeds is 0; it must be above 0");
  CHECK(problem({"mesh", "i", "--speeds", "1,,2"}) == "--speeds is '', which is not a number");
}

TEST_CASE("Whole numbers have the limits of their types") {
  const auto problem_with = [](auto& number, const std::string& text) -> std::string {
    try {
      into(number)(text);
    } catch (const UsageError& error) {
      return error.what();
    }
    return "none";
  };
  std::uint64_t seed = 0;
  for (const std::string text : {"-1", "18446744073709551616"})
    CHECK(problem_with(seed, text) == "is " + text + "; it must be from 0 to 18446744073709551615");
  CHECK(problem_with(seed, "18446744073709551615") == "none");
  CHECK(seed == UINT64_MAX);
  std::int64_t number = 0;
  CHECK(problem_with(number, "9223372036854775808") ==
        "is 9223372036854775808; it must be from -9223372036854775808 to 9223372036854775807");
  CHECK(problem_with(number, "-9223372036854775808") == "none");
  CHECK(number == INT64_MIN);
  std::int32_t small = 0;
  CHECK(problem_with(small, "2147483648") == "is 2147483648; it must be from -2147483648 to 2147483647");
  CHECK(problem_with(small, "--1") == "is '--1', which is not a whole number");
}

TEST_CASE("An option that prints something ends parsing") {
  Program p;
  p.read({"mesh", "--help", "--nonsense"});
  CHECK(p.call.prints() == help_text("prog mesh", p.root.commands[0]));
  Program q;
  q.read({"--version", "nonsense"});
  CHECK(q.call.prints() == "7\n");
}

TEST_CASE("A call says what was given, in order") {
  Program p;
  p.read({"mesh", "-oa.vtu", "--area=7", "in", "-q"});
  std::string said;
  for (const Call::Given& given : p.call.given) said += given.option->name + "=" + given.value + " ";
  CHECK(said == "output=a.vtu area=7 input=in quiet= ");
  CHECK(p.call.has("area"));
  CHECK(!p.call.has("count"));
}

TEST_CASE("Help lists everything, in lines that fit") {
  Program p;
  Command& mesh = p.root.commands[0];
  const std::string text = help_text("prog mesh", mesh);
  CHECK(text.starts_with("Make a mesh\nUsage: prog mesh [OPTIONS] INPUT\n\nArguments:\n  INPUT  "));
  CHECK(text.find("\nOptions:\n  -h, --help  ") != std::string::npos);
  CHECK(text.find("\nTriangles:\n  -a, --area AREA  ") != std::string::npos);
  CHECK(text.find("  --order ORDER               Which comes next: given, largest or backlog [given]\n") !=
        std::string::npos);
  CHECK(help_text("prog", p.root).find("\nCommands:\n  mesh                        Make a mesh\n") !=
        std::string::npos);
  mesh.options.push_back({.name = "a-name-that-fills-its-column", .value = "X", .help = std::string(80, 'x') + " end"});
  const std::string wide = help_text("prog mesh", mesh);
  CHECK(wide.find("  --a-name-that-fills-its-column X\n" + std::string(30, ' ') + "xxx") != std::string::npos);
  CHECK(wide.find("x\n" + std::string(30, ' ') + "end\n") != std::string::npos);
}

TEST_CASE("a command takes its switches, wherever they are, but not the values of options") {
  Program program;
  program.read({"old", "-pq30", "in", "--order", "-x", "-a0.1"});
  CHECK(program.switches == "-pq30-a0.1");
  CHECK(program.input == "in");
  CHECK(program.order == "-x");
  CHECK(problem({"old", "--other", "-p"}).find("--other") != std::string::npos);
  CHECK(problem({"mesh", "in", "-pq30"}) != "none");  // others do not
}
