#include "decompose/decomposition_file.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <random>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "base/read_file.hpp"
#include "decompose/check_decomposition.hpp"
#include "decompose/decompose.hpp"
#include "decompose/same_input.hpp"
#include "decompose/same_segments.hpp"
#include "driftmesh/error.hpp"
#include "mesh/cdt.hpp"
#include "support/prepared_mesh.hpp"
#include "support/varied_domain.hpp"
#include "temporary_folder.hpp"

using namespace driftmesh;
using driftmesh::testing::prepared;

namespace {

Decomposition sample() {
  DecomposeOptions options;
  options.subdomains = 5;
  return decompose(prepared(testing::varied_domain()), options);
}

std::string sample_text() {
  const TemporaryFolder folder;
  const std::string path = (folder.path() / "sample").string();
  write_decomposition(sample(), testing::varied_domain(), path);
  return read_file(path);
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

Decomposition parse(const std::string& text) {
  return parse_decomposition("f", text, testing::varied_domain());
}

}  // namespace

TEST_CASE("a decomposition is read back as it was written") {
  const Decomposition d = sample();
  const Decomposition back = parse(sample_text());
  CHECK(back == d);
  CHECK(!d.point_list.empty());
  require_same_input(back, testing::varied_domain(), "f");
}

TEST_CASE("files that are not decompositions are rejected with file and line") {
  const std::string text = sample_text();
  CHECK_THROWS_WITH_AS(parse(""), doctest::Contains("f:1: this is not a decomposition"), InputError);
  CHECK_THROWS_WITH_AS(parse(replaced(text, "decomposition 2", "decomposition 1")), doctest::Contains("f:1:"),
                       InputError);
  CHECK_THROWS_WITH_AS(parse(text.substr(0, text.size() / 2)), doctest::Contains("f:"), InputError);
  CHECK_THROWS_WITH_AS(parse(text + "1 2\n"), doctest::Contains("more records than"), InputError);
  CHECK_THROWS_WITH_AS(parse(replaced(text, "separator\n", "separator\n-1 5 ")), doctest::Contains("first point"),
                       InputError);
  CHECK_THROWS_WITH_AS(parse(replaced(text, "separator\n", "separator\n999999 5 ")),
                       doctest::Contains("is 999999; expected 0 to"), InputError);
}

TEST_CASE("a broken decomposition is rejected with the reason") {
  Decomposition d = sample();
  const TemporaryFolder folder;
  const std::string path = (folder.path() / "broken").string();
  const auto refused = [&](const Decomposition& broken, const char* why) {
    write_decomposition(broken, testing::varied_domain(), path);
    CHECK_THROWS_WITH_AS(static_cast<void>(read_decomposition(path, testing::varied_domain())), doctest::Contains(why),
                         InputError);
  };
  Decomposition broken = d;
  broken.points[static_cast<GlobalPointId>(broken.points.size() / 2)].x += 100;
  refused(broken, "broken");
  broken = d;
  broken.subdomains[SubdomainId{3}].area *= 1.5;
  refused(broken, "claims area");
  broken = d;
  for (auto& root : broken.roots)
    if (root.separator) {
      std::swap(root.left, root.right);
      break;
    }
  refused(broken, "disagree on the subdomain");
}

TEST_CASE("damaged files are rejected or read, but never crash the reader") {
  const std::string text = sample_text();
  std::mt19937 random(7);
  std::size_t refused = 0;
  for (int i = 0; i < 400; ++i) {
    std::string damaged = text;
    for (int k = 0; k < 3; ++k) damaged[random() % damaged.size()] = "0123456789-. \nx"[random() % 15];
    try {
      const Decomposition d = parse(damaged);
      CHECK(d.size() >= 1);
    } catch (const InputError&) {
      ++refused;
    }
  }
  CHECK(refused > 100);
}

TEST_CASE("a decomposition of another input is recognized") {
  const auto refused = [text = sample_text()](const Pslg& other) {
    CHECK_THROWS_WITH_AS(static_cast<void>(parse_decomposition("f", text, other)), doctest::Contains("another input"),
                         InputError);
  };
  Pslg other = testing::varied_domain();
  other.points[2].y = 1.6;
  refused(other);
  other = testing::varied_domain();
  other.segments.push_back({0, 4, 0});
  refused(other);
  other = testing::varied_domain();
  other.segments.pop_back();
  refused(other);
  other = testing::varied_domain();
  other.segments[3].marker = 9;
  refused(other);
  other = testing::varied_domain();
  other.holes.clear();
  refused(other);
  other = testing::varied_domain();
  other.regions.clear();
  refused(other);
  other = testing::varied_domain();
  other.regions[0].max_area = 0.1;  // a bound: other work, the same subdomains
  CHECK(parse_decomposition("f", sample_text(), other) == sample());
}

TEST_CASE("a decomposition in memory of another input is recognized, except for segments that it lacks") {
  const auto refused = [](const Pslg& other, const char* why) {
    CHECK_THROWS_WITH_AS(require_same_input(sample(), other, "f"), doctest::Contains(why), InputError);
  };
  Pslg other = testing::varied_domain();
  other.points[2].y = 1.6;
  refused(other, "is not point 2 of the input");
  other = testing::varied_domain();
  std::erase_if(other.segments, [](const Pslg::Segment& s) { return s.a == 8 && s.b == 9; });
  refused(other, "which has a segment from point 8 to point 9 with marker 6");
  other = testing::varied_domain();
  other.segments[3].marker = 9;  // the segment from 3 to 2, on which separators end
  refused(other, "with marker 3");
  other = testing::varied_domain();
  other.regions.clear();
  refused(other, "with more than 0 regions");
}

namespace {

std::string text_of(double value) {
  std::ostringstream text;
  text << std::setprecision(17) << value;
  return text.str();
}

/// Other values for a field of a decomposition's file.
std::vector<std::string> edits_of(const std::string& field) {
  std::vector<std::string> edits;
  if (field.find_first_of(".e") == std::string::npos) {
    const long value = std::stol(field);
    for (const long other : {value - 1, value + 1, value + 3, -value, 0L, 1L})
      if (other != value) edits.push_back(std::to_string(other));
  } else {
    const double value = std::stod(field);
    for (const double other : {value * (1 + 1e-7), value + 0.01, -value, 0.0})
      if (other != value) edits.push_back(text_of(other));
  }
  return edits;
}

/// A fan of segments that meet at sharp angles: shells on many circles, and segments that end inside the domain.
Pslg fan_input() {
  Pslg pslg;
  pslg.points = {{0, 0}, {10, 0}, {10, 10}, {0, 10}, {5, 5}};
  pslg.segments = {{0, 1, 1}, {1, 2, 2}, {2, 3, 3}, {3, 0, 4}};
  for (int i = 0; i < 7; ++i) {
    pslg.points.push_back({5 + 3 * std::cos(0.15 * i), 5 + 3 * std::sin(0.15 * i)});
    pslg.segments.push_back({4, 5 + i, 10 + i});
  }
  return pslg;
}

}  // namespace

TEST_CASE("every edit of a point, a root or an inner point is noticed") {
  const TemporaryFolder folder;
  for (const Pslg& input : {testing::varied_domain(), fan_input()}) {
    const Triangulation domain = prepared(input);
    DecomposeOptions options;
    options.subdomains = 6;
    const std::string path = (folder.path() / "whole").string();
    write_decomposition(decompose(domain, options), input, path);
    const auto accepts = [&](const std::string& text) {
      try {
        require_same_segments(parse_decomposition("f", text, input), domain, "f");
        return true;
      } catch (const InputError&) {
        return false;
      }
    };
    std::istringstream file(read_file(path));
    std::vector<std::string> lines;
    for (std::string line; std::getline(file, line);) lines.push_back(line);
    REQUIRE(accepts(read_file(path)));
    std::string section;
    std::size_t edited = 0, roots = 0;
    for (std::string& line : lines) {
      if (line.starts_with('#')) section = line;
      if (line.starts_with('#') || section.starts_with("# subdomains")) continue;  // in subdomains only the area binds
      roots += section.starts_with("# roots") ? 1 : 0;
      const std::string whole = line;
      for (std::size_t begin = 0; begin < whole.size();
           begin = std::min(whole.find(' ', begin), whole.size() - 1) + 1) {
        const std::size_t length = std::min(whole.find(' ', begin), whole.size()) - begin;
        for (const std::string& other : edits_of(whole.substr(begin, length))) {
          line = std::string(whole).replace(begin, length, other);
          std::string text;
          for (const std::string& l : lines) text += l + "\n";
          CAPTURE(section);
          CAPTURE(whole);
          CAPTURE(line);
          CHECK_FALSE(accepts(text));
          ++edited;
        }
      }
      line = whole;
    }
    CHECK(roots > 10);
    CHECK(edited > 1000);
  }
}

TEST_CASE("a shell piece that runs toward its corner is refused") {
  const Triangulation domain = prepared(fan_input());
  DecomposeOptions options;
  options.subdomains = 6;
  Decomposition d = decompose(domain, options);
  require_same_segments(d, domain, "f");
  std::size_t pieces = 0;
  for (Decomposition::Root& root : d.roots) {
    if (root.shell == kNone) continue;
    const Decomposition::Root whole = root;
    std::swap(root.a, root.b);
    std::swap(root.left, root.right);
    std::swap(root.left_region, root.right_region);
    CHECK(check_decomposition(d).valid());  // it fits its neighbors: only the input tells
    CHECK_THROWS_WITH_AS(require_same_segments(d, domain, "f"), doctest::Contains("runs against its shell piece"),
                         InputError);
    root = whole;
    ++pieces;
  }
  CHECK(pieces > 10);
}

TEST_CASE("inputs that make other meshes have other digests") {
  Pslg input = testing::varied_domain();
  input.polygons.push_back({.rings = {{0, 1, 2, 3}}});
  const std::int32_t digest = input_digest(input);
  const auto changed = [&](const auto& change) {
    Pslg other = input;
    change(other);
    return input_digest(other) != digest;
  };
  CHECK_FALSE(changed([](Pslg&) {}));
  CHECK(changed([](Pslg& p) { p.points[2].y += 1e-9; }));
  CHECK(changed([](Pslg& p) { p.segments[0].marker = 50; }));
  CHECK(changed([](Pslg& p) { p.segments[3].b += 1; }));
  CHECK(changed([](Pslg& p) { p.holes[0].x += 1e-9; }));
  CHECK(changed([](Pslg& p) { p.holes.clear(); }));
  CHECK(changed([](Pslg& p) { std::swap(p.polygons[0].rings[0][1], p.polygons[0].rings[0][2]); }));
  CHECK(changed([](Pslg& p) { p.regions.clear(); }));
}

TEST_CASE("a file lists inner points once, and subdomains with their work") {
  const std::string text = sample_text();
  Decomposition d = sample();
  REQUIRE(!d.point_list.empty());
  const TemporaryFolder folder;
  const std::string path = folder.path() / "twice";
  std::size_t i = 0;  // a subdomain with an inner point
  while (d.point_begin[i + 1] == d.point_begin[i]) ++i;
  Decomposition twice = d;
  twice.point_list.insert(twice.point_list.begin() + d.point_begin[i],
                          d.point_list[static_cast<std::size_t>(d.point_begin[i])]);
  for (std::size_t k = i + 1; k < twice.point_begin.size(); ++k) ++twice.point_begin[k];
  write_decomposition(twice, testing::varied_domain(), path);
  CHECK_THROWS_AS((void)read_decomposition(path, testing::varied_domain()), InputError);
  d.subdomains[SubdomainId{1}].predicted = 0;
  write_decomposition(d, testing::varied_domain(), path);
  CHECK_THROWS_AS((void)read_decomposition(path, testing::varied_domain()), InputError);
}
