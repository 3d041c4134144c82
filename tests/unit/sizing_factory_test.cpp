#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include "driftmesh/error.hpp"
#include "sizing/make_size_field.hpp"
#include "support/error_text.hpp"
#include "support/infinity.hpp"

using namespace driftmesh;
using namespace driftmesh::testing;

namespace {

/// A temporary folder of files.
class Folder {
 public:
  Folder() {
    std::string name = (std::filesystem::temp_directory_path() / "driftmesh_sizing_XXXXXX").string();
    path_ = mkdtemp(name.data());
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  void write(const std::string& name, const std::string& text) const { std::ofstream(path_ / name) << text; }
  [[nodiscard]] std::string path(const std::string& name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

/// The unit square in two triangles; points 1 to 4 with `attributes` (a text for each point).
void write_square(const Folder& folder, const char* header, std::initializer_list<const char*> attributes) {
  const char* corner[] = {"1 0 0 ", "2 1 0 ", "3 1 1 ", "4 0 1 "};
  std::string text = header;
  int i = 0;
  for (const char* attribute : attributes) text += std::string("\n") + corner[i++] + attribute;
  folder.write("square.node", text + "\n");
  folder.write("square.ele", "2 3 0\n1 1 2 3\n2 1 3 4\n");
}

std::string message_of(const SizingOptions& options) {
  return error_text([&] { (void)make_size_field(options); });
}

}  // namespace

TEST_CASE("no options give no field") {
  CHECK(make_size_field({}) == nullptr);
}

TEST_CASE("an expression and a longest edge are combined") {
  const auto field = make_size_field({.expression = "x", .longest = 2, .shortest = 0.5});
  CHECK(field->edge_length({1, 0}) == 1);
  CHECK(field->edge_length({-1, 0}) == 0.5);
  CHECK(field->edge_length({9, 0}) == 2);
  CHECK(make_size_field({.longest = 2})->edge_length({9, 0}) == 2);
}

TEST_CASE("a background mesh with lengths at its points") {
  const Folder folder;
  write_square(folder, "4 2 2 1", {"0.1 7 1", "0.2 7 1", "0.3 7 1", "0.4 7 1"});
  for (const char* name : {"square", "square.node", "square.ele"}) {
    const auto field = make_size_field({.background = folder.path(name)});
    CHECK(field->edge_length({1, 0}) == 0.2);
    CHECK(field->edge_length({0.5, 0.5}) == doctest::Approx(0.2));
    CHECK(field->edge_length({0, 0.5}) == doctest::Approx(0.25));
  }
  const auto graded = make_size_field({.background = folder.path("square"), .gradation = 0.05});
  CHECK(graded->edge_length({0, 1}) == doctest::Approx(0.15));
  const auto capped = make_size_field(
      {.background = folder.path("square"), .longest = 0.25, .shortest = 0.15, .domain = {{0, 0}, {1, 1}}});
  CHECK(capped->edge_length({0, 1}) == doctest::Approx(0.25));
  CHECK(capped->edge_length({0, 0}) == doctest::Approx(0.15));
}

TEST_CASE("a background mesh with area bounds") {
  const Folder folder;
  write_square(folder, "4 2 0 0", {"", "", "", ""});
  folder.write("square.area", "2\n1 0.01\n2 -1\n");
  const double fine = std::sqrt(0.04 / std::sqrt(3.0));
  const auto field = make_size_field({.background = folder.path("square.area")});
  CHECK(field->edge_length({0.9, 0.5}) == doctest::Approx(fine));
  CHECK(field->edge_length({0.1, 0.5}) == kInfinity);
  const auto graded = make_size_field({.background = folder.path("square.area"), .gradation = 0.25});
  CHECK(graded->edge_length({1, 0}) == doctest::Approx(fine));
  CHECK(graded->edge_length({0, 1}) == doctest::Approx(fine + 0.25));
}

TEST_CASE("errors in sizing options are named") {
  const Folder folder;
  write_square(folder, "4 2 0 0", {"", "", "", ""});
  CHECK(mentions(message_of({.background = folder.path("square")}), "square.node: its points have no attribute"));
  CHECK(mentions(message_of({.background = folder.path("square.area")}), "square.area"));
  CHECK(mentions(message_of({.background = folder.path("absent")}), "absent.node"));
  write_square(folder, "4 2 1 0", {"1", "1", "0", "1"});
  CHECK(mentions(message_of({.background = folder.path("square")}), "point 3 is 0"));
  CHECK(mentions(message_of({.background = folder.path("square"), .gradation = 0.0}), "gradation"));
  CHECK(mentions(message_of({.background = folder.path("square"), .gradation = -1e-9}), "gradation: -1e-09;"));
  CHECK(mentions(message_of({.background = folder.path("square"), .gradation = std::nan("")}), "gradation"));
  folder.write("square.ele", "1 3 0\n1 1 2 2\n");
  CHECK(mentions(message_of({.background = folder.path("square")}), "square.ele"));
  CHECK(mentions(message_of({.expression = "x +"}), "size expression"));
  CHECK(mentions(message_of({.longest = 0}), "longest edge length"));
  CHECK(mentions(message_of({.longest = 1, .shortest = 2}), "shortest edge length"));
  CHECK(mentions(message_of({.shortest = std::nan("")}), "shortest edge length"));
}
