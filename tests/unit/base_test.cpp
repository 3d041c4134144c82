#include <doctest/doctest.h>

#include <cerrno>
#include <cstdint>
#include <string>

#include "base/letter_case.hpp"
#include "base/narrow.hpp"
#include "base/nearest_name.hpp"
#include "driftmesh/error.hpp"

using namespace driftmesh;

TEST_CASE("an input error names file, line, cause and next step") {
  const InputError error({"bay.poly", 17}, "vertex 9 does not exist", "the file has 8 vertices");
  CHECK(std::string(error.what()) == "bay.poly:17: vertex 9 does not exist; the file has 8 vertices");
}

TEST_CASE("a file error carries the system's reason") {
  errno = ENOENT;
  CHECK(std::string(FileError("x.node", "cannot open").what()) == "x.node: cannot open: No such file or directory");
  errno = 0;
  CHECK(std::string(FileError("x.node", "is empty").what()) == "x.node: is empty");
}

TEST_CASE("narrow rejects values that do not fit") {
  CHECK(narrow<std::int32_t>(std::size_t{2147483647}, "count") == 2147483647);
  CHECK_THROWS_AS((void)narrow<std::int32_t>(std::size_t{2147483648}, "count"), LimitError);
  CHECK_THROWS_AS((void)narrow<std::uint32_t>(-1, "count"), LimitError);
}

TEST_CASE("only letters of ASCII have a case") {
  CHECK(lower_case("GRAPH_2 \xc3\x84z") == "graph_2 \xc3\x84z");  // U+00C4, which is a letter to locales
  CHECK(upper_case("input \xc3\xa4Z") == "INPUT \xc3\xa4Z");
  CHECK(lower_case("@[`{") == "@[`{");
  CHECK(upper_case("@[`{") == "@[`{");
}

TEST_CASE("the nearest name is the one with the fewest changes") {
  const std::vector<std::string> known{"none", "zoltan", "diffusion", "IMBALANCE_TOL"};
  CHECK(nearest_name("soltan", known) == "zoltan");
  CHECK(nearest_name("diffuse", known) == "diffusion");
  CHECK(nearest_name("imbalance", known) == "IMBALANCE_TOL");
  CHECK(nearest_name("none", known) == "none");
  CHECK(nearest_name("x", {}) == "");
}

TEST_CASE("a name that contains the word is nearer than one that looks like it") {
  const std::vector<std::string> known{"size", "max_area", "region_areas", "ranks.map_by_area", "max-memory", "gap"};
  CHECK(nearest_name("area", known) == "max_area");
  CHECK(nearest_name("AREA", known) == "max_area");
  CHECK(nearest_name("memory", known) == "max-memory");
  CHECK(nearest_name("size", known) == "size");
  CHECK(nearest_name("map", known) == "ranks.map_by_area");
  CHECK(nearest_name("by_area", known) == "ranks.map_by_area");
  CHECK(nearest_name("pie", {"piece", "pipe"}) == "pipe");  // not a word of it
  CHECK(nearest_name("rank", {"rank-speeds", "ranks"}) == "ranks");
  CHECK(nearest_name("", known) == "gap");
  CHECK(probable_name("memory", known) == "max-memory");
  CHECK(probable_name("by", known) == "ranks.map_by_area");
}

TEST_CASE("two letters in the wrong order are one change") {
  CHECK(nearest_name("ab", {"abc", "xb", "ba"}) == "abc");
  CHECK(nearest_name("bya", {"bay", "pipe"}) == "bay");
  CHECK(nearest_name("abcd", {"acbde", "bacd"}) == "bacd");
}

TEST_CASE("a name is probably meant if most of its letters match, or if it begins with the given one") {
  const std::vector<std::string> known{"mesh", "subdomains", "run", "bay", "bash"};
  CHECK(probable_name("mseh", known) == "mesh");
  CHECK(probable_name("bya", known) == "bay");
  CHECK(probable_name("tcsh", known) == "");
  CHECK(probable_name("subodmian", known) == "subdomains");
  CHECK(probable_name("sub", known) == "subdomains");
  CHECK(probable_name("publish", known) == "");
  CHECK(probable_name("xyz", known) == "");
}
