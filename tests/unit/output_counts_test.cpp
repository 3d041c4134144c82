#include <doctest/doctest.h>

#include <cstring>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "driftmesh/error.hpp"
#include "io/mesh_file.hpp"
#include "support/damage.hpp"
#include "support/mesh_equality.hpp"
#include "support/random_mesh.hpp"
#include "temporary_folder.hpp"

// Every number of records or columns that a mesh file declares is compared with the records themselves.

using namespace driftmesh;
using namespace driftmesh::test;

namespace {

std::vector<std::string> lines_of(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

/// The line with a number added to one of its fields; nothing if there is no such field, or it would fall below 0.
std::optional<std::string> edited(const std::string& line, std::size_t field, long add) {
  std::istringstream words(line);
  std::string result;
  bool done = false;
  std::size_t at = 0;
  for (std::string word; words >> word; ++at) {
    if (at == field) {
      const long value = std::stol(word) + add;
      if (value < 0) return std::nullopt;
      word = std::to_string(value);
      done = true;
    }
    result += (result.empty() ? "" : " ") + word;
  }
  return done ? std::optional(result) : std::nullopt;
}

std::string refusal(const std::string& path) {
  try {
    (void)read_mesh(path);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

/// Whether a message starts with FILE:LINE:.
bool names_line(const std::string& message, const std::string& path) {
  return message.starts_with(path + ":") && std::isdigit(static_cast<unsigned char>(message[path.size() + 1])) != 0;
}

constexpr long kEdits[] = {-1000000, -4, -2, -1, 1, 2, 7};

/// Checks each edit of each field of one line. What a file declares for records that are not there is all the same.
void check_header_line(const std::string& set, const std::string& path, std::size_t line) {
  const std::string whole = file_bytes(path);
  const std::vector<std::string> lines = lines_of(whole);
  for (std::size_t field = 0; field < 4; ++field)
    for (long add : kEdits) {
      if (add == -1000000) add = -std::stol("0" + lines[line]);  // to zero, if it is the first field
      const auto changed = edited(lines[line], field, add);
      if (!changed || *changed == lines[line]) continue;
      std::vector<std::string> copy = lines;
      copy[line] = *changed;
      replace_file(path, joined(copy));
      CAPTURE(*changed);
      const std::string message = refusal(set);
      CHECK(message != "accepted");
      CHECK(names_line(message, path));
    }
  replace_file(path, whole);
}

}  // namespace

TEST_CASE("the counts in Triangle's files") {
  const TemporaryFolder folder;
  const std::string stem = folder.path() / "mesh", set = stem + ".ele";
  write_mesh(RandomMesh(5, 5, 4).mesh(), set, {{{0.5, 0.5}}});
  for (const char* file : {".node", ".ele"}) {
    CAPTURE(file);
    check_header_line(set, stem + file, 0);
  }
  const std::vector<std::string> poly = lines_of(file_bytes(stem + ".poly"));
  check_header_line(set, stem + ".poly", 1);
  check_header_line(set, stem + ".poly", poly.size() - 2);  // holes
  std::filesystem::remove(stem + ".poly");
  check_header_line(set, stem + ".edge", 0);
}

TEST_CASE("an .ele that declares fewer triangles than it has, or none, is refused with the line") {
  const TemporaryFolder folder;
  const std::string stem = folder.path() / "mesh", set = stem + ".ele";
  write_mesh(RandomMesh(5, 4, 3, {.regions = false}).mesh(), set);
  std::vector<std::string> lines = lines_of(file_bytes(set));
  for (const auto& [header, line] : {std::pair("0 3 0", ":2: "), {"20 3 0", ":22: "}}) {
    lines[0] = header;
    replace_file(set, joined(lines));
    CHECK(refusal(set).starts_with(set + line + "there are more records than announced"));
  }
}

TEST_CASE("trailing data in Triangle's files") {
  const TemporaryFolder folder;
  const std::string stem = folder.path() / "mesh", set = stem + ".ele";
  write_mesh(RandomMesh(5, 4, 3).mesh(), set);
  for (const char* file : {".node", ".ele", ".poly", ".edge"}) {
    if (std::string(file) == ".edge") std::filesystem::remove(stem + ".poly");
    const std::string path = stem + file, whole = file_bytes(path);
    const std::size_t size = lines_of(whole).size();
    for (const char* more : {"5 6 7 8\n", "nonsense\n", "1\n"}) {
      replace_file(path, whole + more);
      CHECK(refusal(set).starts_with(path + ":" + std::to_string(size + 1) + ":"));
    }
    replace_file(path, whole + "# a comment\n\n");
    CHECK(refusal(set) == "accepted");
    replace_file(path, whole);
  }
}

TEST_CASE("surplus fields are refused unless they are zeros, which lose nothing") {
  const TemporaryFolder folder;
  const std::string stem = folder.path() / "mesh", set = stem + ".ele";
  const Mesh mesh = RandomMesh(5, 4, 3).mesh();
  write_mesh(mesh, set);
  for (const char* file : {".node", ".ele", ".poly"}) {
    const std::string path = stem + file, whole = file_bytes(path);
    std::vector<std::string> lines = lines_of(whole);
    lines[2] += " 0";
    replace_file(path, joined(lines));
    check_same_mesh(read_mesh(set), mesh);
    lines[2] += " 3";
    replace_file(path, joined(lines));
    CHECK(refusal(set).starts_with(path + ":3: the line has more fields than announced, from '3' on"));
    replace_file(path, whole);
  }
}

TEST_CASE("the counts in an ASCII .msh") {
  const TemporaryFolder folder;
  const std::string path = folder.path() / "mesh.msh";
  const std::string whole =
      "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n"
      "$PhysicalNames\n2\n1 7 \"inlet\"\n2 3 \"fluid\"\n$EndPhysicalNames\n"
      "$Entities\n1 2 1 0\n1 0 0 0 0\n1 0 0 0 1 0 0 1 7 2 1 -1\n2 1 0 0 1 1 0 1 9 0\n1 0 0 0 1 1 0 1 3 2 1 "
      "2\n$EndEntities\n"
      "$Nodes\n2 4 1 4\n1 1 0 2\n1\n2\n0 0 0\n1 0 0\n2 1 0 2\n3\n4\n1 1 0\n0 1 0\n$EndNodes\n"
      "$Elements\n4 5 1 5\n0 1 15 1\n1 1\n1 1 1 1\n2 1 2\n1 2 1 1\n3 2 3\n2 1 2 2\n4 1 2 3\n5 1 3 4\n$EndElements\n"
      "$NodeData\n1\n\"attribute 1\"\n1\n0\n3\n0\n1\n4\n1 0.5\n2 1.5\n3 2.5\n4 3.5\n$EndNodeData\n"
      "$ElementData\n1\n\"subdomain\"\n1\n0\n3\n0\n1\n2\n4 0\n5 1\n$EndElementData\n"
      "$DriftmeshPointMarkers\n2\n1 5\n4 6\n$EndDriftmeshPointMarkers\n";
  replace_file(path, whole);
  CHECK(refusal(path) == "accepted");
  const std::vector<std::string> lines = lines_of(whole);
  const auto check = [&](const std::string& line, std::size_t after, std::initializer_list<std::size_t> fields) {
    std::size_t at = after;
    while (lines.at(at) != line) ++at;
    for (const std::size_t field : fields)
      for (const long add : {-4, -2, -1, 1, 2, 100000000}) {
        const auto changed = edited(line, field, add);
        if (!changed) continue;
        std::vector<std::string> copy = lines;
        copy[at] = *changed;
        replace_file(path, joined(copy));
        CAPTURE(*changed);
        CHECK(names_line(refusal(path), path));
      }
  };
  const auto section = [&](const char* name) {
    std::size_t at = 0;
    while (lines[at] != name) ++at;
    return at;
  };
  check("2", section("$PhysicalNames"), {0});
  check("1 2 1 0", section("$Entities"), {0, 1, 2, 3});
  check("1 0 0 0 1 0 0 1 7 2 1 -1", section("$Entities"), {9});
  check("2 4 1 4", section("$Nodes"), {0, 1});
  check("1 1 0 2", section("$Nodes"), {3});
  check("2 1 0 2", section("$Nodes"), {3});
  check("4 5 1 5", section("$Elements"), {0, 1});
  check("0 1 15 1", section("$Elements"), {0, 1, 2, 3});
  check("1 2 1 1", section("$Elements"), {0, 2, 3});
  check("2 1 2 2", section("$Elements"), {0, 1, 2, 3});
  check("4", section("$NodeData"), {0});
  check("2", section("$ElementData"), {0});
  check("2", section("$DriftmeshPointMarkers"), {0});
}

TEST_CASE("the counts in a binary .msh") {
  const TemporaryFolder folder;
  const std::string path = folder.path() / "mesh.msh";
  const Mesh mesh = RandomMesh(5, 5, 4).mesh();
  write_mesh(mesh, path);
  const std::string whole = file_bytes(path);
  const auto check = [&](const char* section, std::size_t offset) {
    const std::size_t at = whole.find(section) + std::strlen(section) + 1 + offset;
    std::uint64_t count = 0;
    std::memcpy(&count, whole.data() + at, sizeof count);
    for (const int add : {-2, -1, 1, 2, 1 << 30}) {
      if (add < 0 && count < static_cast<std::uint64_t>(-add)) continue;
      const std::uint64_t wrong = count + static_cast<std::uint64_t>(add);
      std::string copy = whole;
      std::memcpy(copy.data() + at, &wrong, sizeof wrong);
      replace_file(path, copy);
      CAPTURE(section);
      CAPTURE(offset);
      CAPTURE(wrong);
      CHECK(refusal(path).starts_with(path + ": "));
    }
  };
  for (const std::size_t offset : {0, 8, 16, 24}) check("$Entities", offset);
  for (const std::size_t offset : {0, 8, 44}) check("$Nodes", offset);
  for (const std::size_t offset : {0, 8, 44}) check("$Elements", offset);
  replace_file(path, whole);
  check_same_mesh(read_mesh(path), mesh);
}
