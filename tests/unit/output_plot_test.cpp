#include <cairo.h>
#include <doctest/doctest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <random>
#include <set>

#include "driftmesh/error.hpp"
#include "io/xml_scanner.hpp"
#include "picture/ascii_text.hpp"
#include "picture/plot.hpp"
#include "picture/plot_color.hpp"
#include "picture/plot_raster.hpp"
#include "picture/plot_scale.hpp"
#include "support/damage.hpp"
#include "support/random_mesh.hpp"
#include "temporary_folder.hpp"

using namespace driftmesh;
using namespace driftmesh::test;

namespace {

// A PNG read back.
class Picture {
 public:
  explicit Picture(const std::string& path) : surface_(cairo_image_surface_create_from_png(path.c_str())) {
    REQUIRE(cairo_surface_status(surface_) == CAIRO_STATUS_SUCCESS);
  }
  ~Picture() { cairo_surface_destroy(surface_); }
  Picture(const Picture&) = delete;
  Picture& operator=(const Picture&) = delete;
  [[nodiscard]] int width() const { return cairo_image_surface_get_width(surface_); }
  [[nodiscard]] int height() const { return cairo_image_surface_get_height(surface_); }
  [[nodiscard]] std::uint32_t at(int x, int y) const {
    const unsigned char* const row =
        cairo_image_surface_get_data(surface_) + y * cairo_image_surface_get_stride(surface_);
    std::uint32_t pixel = 0;
    std::memcpy(&pixel, row + 4 * x, 4);
    return pixel & 0xffffff;
  }
  // The number of pixels of a rectangle that are not white.
  [[nodiscard]] int drawn(int left, int top, int right, int bottom) const {
    int count = 0;
    for (int y = top; y < bottom; ++y)
      for (int x = left; x < right; ++x) count += at(x, y) == 0xffffff ? 0 : 1;
    return count;
  }

 private:
  cairo_surface_t* surface_;
};

// The unit square with a hole in its middle third, as a ring of triangles; scaled to 3 x 3.
Mesh square_with_hole() {
  Mesh mesh;
  mesh.points = {{0, 0}, {3, 0}, {3, 3}, {0, 3}, {1, 1}, {2, 1}, {2, 2}, {1, 2}};
  mesh.triangles = {{0, 1, 5}, {0, 5, 4}, {1, 2, 6}, {1, 6, 5}, {2, 3, 7}, {2, 7, 6}, {3, 0, 4}, {3, 4, 7}};
  mesh.regions = {1, 1, 2, 2, 3, 3, 4, 4};
  return mesh;
}

}  // namespace

TEST_CASE("scan conversion gives every sample to exactly one triangle of a mesh") {
  for (std::uint32_t seed = 1; seed <= 20; ++seed) {
    CAPTURE(seed);
    const RandomMesh random(seed, 7, 5, {}, 60);
    const Mesh& mesh = random.mesh();
    std::vector<int> hits(60 * 60 * 4, 0);
    double area = 0;
    for (const auto& triangle : mesh.triangles) {
      ValueRaster raster(60, 60, 2, ValueRaster::Keep::kLast);
      const Point& a = mesh.points[triangle[0]];
      const Point& b = mesh.points[triangle[1]];
      const Point& c = mesh.points[triangle[2]];
      raster.add_triangle(a, b, c, 1);
      area += ((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)) / 2;
      for (int y = 0; y < 60; ++y)
        for (int x = 0; x < 60; ++x)
          hits[60 * y + x] += static_cast<int>(std::lround(4 * raster.pixel(x, y, viridis).coverage));
    }
    double covered = 0;
    for (int count : hits) {
      CHECK(count <= 4);
      covered += count / 4.0;
    }
    CHECK(covered == doctest::Approx(area).epsilon(0.01));
  }
}

TEST_CASE("a pixel of many triangles shows the worst or the mean of them, including those without a sample") {
  const auto red = [](double value) { return Rgb{value, 0, 0}; };
  for (const auto& [keep, expected] : {std::pair{ValueRaster::Keep::kMinimum, 0.25}, {ValueRaster::Keep::kMean, 0.5}}) {
    ValueRaster raster(3, 3, 1, keep);
    raster.add_triangle({1.1, 1.1}, {1.2, 1.1}, {1.1, 1.2}, 0.25F);
    raster.add_triangle({1.8, 1.8}, {1.9, 1.8}, {1.8, 1.9}, 0.75F);
    raster.add_triangle({-5, -5}, {-4, -5}, {-5, -4}, 0.1F);
    CHECK(raster.pixel(1, 1, red).color.red == doctest::Approx(expected));
    CHECK(raster.pixel(1, 1, red).coverage == 1);
    CHECK(raster.pixel(0, 0, red).coverage == 0);
  }
}

TEST_CASE("a triangle far larger than the raster is cut off at its sides") {
  ValueRaster raster(4, 3, 2, ValueRaster::Keep::kLast);
  raster.add_triangle({-1e30, -1e30}, {1e30, -1e30}, {0, 1e30}, 1);
  for (int y = 0; y < 3; ++y)
    for (int x = 0; x < 4; ++x) CHECK(raster.pixel(x, y, viridis).coverage == 1);
}

TEST_CASE("ticks are round, in range and told apart by their labels") {
  std::mt19937 random(7);
  for (int round = 0; round < 2000; ++round) {
    CAPTURE(round);
    const double low =
        std::ldexp(std::uniform_real_distribution<double>(-1, 1)(random), static_cast<int>(random() % 60) - 30);
    const double high = low + std::ldexp(1.0 + (random() % 100) / 100.0, static_cast<int>(random() % 40) - 20);
    const double size = std::max(std::fabs(low), std::fabs(high));
    if (high - low < 1e-9 * size) continue;
    const std::vector<Tick> ticks = linear_ticks(low, high, 8);
    CHECK(ticks.size() >= 3);
    CHECK(ticks.size() <= 10);
    std::set<std::string> labels;
    for (const Tick& tick : ticks) {
      CHECK(tick.value >= low - 1e-6 * (high - low));
      CHECK(tick.value <= high + 1e-6 * (high - low));
      labels.insert(tick.label);
    }
    CHECK(labels.size() == ticks.size());
  }
  CHECK(linear_ticks(0, 60, 6).size() == 7);
  CHECK(linear_ticks(0, 60, 6)[2].label == "20");
  CHECK(linear_ticks(1, 1, 5).empty());
  CHECK(logarithmic_ticks(0.5, 2000, 7).size() == 4);
  CHECK(logarithmic_ticks(0.02, 3, 7).size() == 7);
  CHECK(logarithmic_ticks(2100, 5300, 6).size() == 3);
  CHECK(logarithmic_ticks(-1, 2, 7).empty());
}

TEST_CASE("numbers are written as people write them") {
  CHECK(grouped_digits(0) == "0");
  CHECK(grouped_digits(999) == "999");
  CHECK(grouped_digits(1000) == "1,000");
  CHECK(grouped_digits(12345678) == "12,345,678");
  CHECK(friendly_number(0) == "0");
  CHECK(friendly_number(0.25) == "0.25");
  CHECK(friendly_number(-4350000) == "-4,350,000");
  CHECK(friendly_number(2.5e-7) == "2.5\u00b710\u207b\u2077");
  CHECK(friendly_number(1e12) == "10\u00b9\u00b2");
}

TEST_CASE("viridis ends in the published colors and gets lighter all the way") {
  CHECK(viridis(0).red == doctest::Approx(0x44 / 255.0));
  CHECK(viridis(-3).blue == doctest::Approx(0x54 / 255.0));
  CHECK(viridis(1).green == doctest::Approx(0xe7 / 255.0));
  double last = 0;
  for (int i = 0; i <= 100; ++i) {
    const Rgb color = viridis(i / 100.0);
    const double luma = 0.2126 * color.red + 0.7152 * color.green + 0.0722 * color.blue;
    CHECK(luma > last);
    last = luma;
  }
}

TEST_CASE("a picture shows triangles in their colors and leaves holes white") {
  const TemporaryFolder folder;
  const std::string path = folder.path() / "mesh.png";
  plot_mesh(square_with_hole(), path, {.width = 800, .height = 600, .color = PlotColor::kPlain, .title = "ring"});
  const Picture picture(path);
  REQUIRE(picture.width() == 800);
  REQUIRE(picture.height() == 600);
  // The square is located by its fill color.
  int left = 800, right = 0, top = 600, bottom = 0;
  for (int y = 70; y < 560; ++y)
    for (int x = 60; x < 790; ++x)
      if (picture.at(x, y) == 0xe8f0f7) {
        left = std::min(left, x), right = std::max(right, x), top = std::min(top, y), bottom = std::max(bottom, y);
      }
  REQUIRE(right - left > 300);
  CHECK(std::abs((right - left) - (bottom - top)) <= 2);
  const int third = (right - left) / 3;
  CHECK(picture.drawn(left + third + 5, top + third + 5, left + 2 * third - 5, top + 2 * third - 5) == 0);
  CHECK(picture.drawn(left + 5, top + 5, left + third - 5, bottom - 5) == (third - 10) * (bottom - top - 10));
}

TEST_CASE("a fine mesh becomes a density image, in SVG embedded") {
  const TemporaryFolder folder;
  const RandomMesh random(5, 250, 250);
  for (PlotColor color : {PlotColor::kAngle, PlotColor::kArea, PlotColor::kRegion}) {
    const std::string path = folder.path() / "fine.svg";
    plot_mesh(random.mesh(), path, {.width = 300, .color = color});
    const std::string text = file_bytes(path);
    CHECK(text.find("data:image/png;base64") != std::string::npos);
    CHECK(text.size() < 500000);
  }
  const std::string path = folder.path() / "fine.png";
  plot_mesh(random.mesh(), path, {.width = 300, .color = PlotColor::kAngle});
  const Picture picture(path);
  CHECK(picture.width() == 300);
  CHECK(picture.drawn(0, 0, 300, picture.height()) > 300 * 300 / 4);
}

TEST_CASE("a coarse mesh in SVG is made of polygons, and the file is XML") {
  const TemporaryFolder folder;
  const std::string path = folder.path() / "mesh.svg";
  plot_mesh(square_with_hole(), path, {.color = PlotColor::kRegion, .title = "a <b> & c"});
  const std::string text = file_bytes(path);
  CHECK(text.find("data:image/png;base64") == std::string::npos);
  XmlScanner scanner(path, text);
  XmlTag tag;
  int paths = 0;
  while (scanner.next(tag)) paths += tag.name == "path" ? 1 : 0;
  CHECK(paths >= 8);
}

TEST_CASE("colors show angles where triangles can be seen, and areas where they cannot") {
  const TemporaryFolder folder;
  const auto bytes = [&](const Mesh& mesh, PlotColor color) {
    const std::string path = (folder.path() / "mesh.png").string();
    plot_mesh(mesh, path, {.width = 300, .color = color, .title = "mesh"});
    return file_bytes(path);
  };
  const Mesh coarse = square_with_hole();
  CHECK(bytes(coarse, PlotColor::kAutomatic) == bytes(coarse, PlotColor::kAngle));
  const Mesh fine = RandomMesh(5, 250, 250).mesh();
  CHECK(bytes(fine, PlotColor::kAutomatic) == bytes(fine, PlotColor::kArea));
  CHECK(bytes(fine, PlotColor::kArea) != bytes(fine, PlotColor::kAngle));
}

TEST_CASE("means go over the triangles around a sample, and nothing gets a value that has none") {
  ValueRaster raster(5, 5, 1, ValueRaster::Keep::kMean);
  const auto put = [&](double x, double y, float value) {
    raster.add_triangle({x, y}, {x + 0.1, y}, {x, y + 0.1}, value);
  };
  put(1.2, 1.2, 0.1F);
  put(1.6, 1.2, 0.3F);
  put(2.2, 2.2, 0.8F);
  put(4.2, 4.2, 0.5F);
  raster.average_around(1);
  const auto value = [&](int x, int y) { return raster.pixel(x, y, [](double v) { return Rgb{v, v, v}; }); };
  CHECK(value(1, 1).color.red == doctest::Approx(0.4));
  CHECK(value(2, 2).color.red == doctest::Approx(0.4));
  CHECK(value(4, 4).color.red == doctest::Approx(0.5));
  CHECK(value(2, 1).coverage == 0);
  CHECK(value(1, 1).coverage == 1);
}

TEST_CASE("text stays inside a narrow picture, and a legend leaves room for the plot") {
  const TemporaryFolder folder;
  const std::string path = folder.path() / "narrow.png";
  const RandomMesh random(5, 250, 250);
  for (const int width : {100, 150, 200, 300, 450, 700}) {
    CAPTURE(width);
    for (const PlotColor color : {PlotColor::kAngle, PlotColor::kArea, PlotColor::kRegion}) {
      plot_mesh(random.mesh(), path,
                {.width = width, .color = color, .title = "a-file-with-a-name-of-medium-length.vtu"});
      const Picture picture(path);
      CHECK(picture.drawn(width - 1, 0, width, picture.height()) == 0);
      CHECK(picture.drawn(0, 0, width, picture.height()) > width * width / 10);
    }
  }
}

TEST_CASE("empty meshes and boxes beside the mesh can be drawn") {
  const TemporaryFolder folder;
  const std::string path = folder.path() / "mesh.png";
  Mesh one_point;
  one_point.points = {{1e9, -1e9}};
  for (PlotColor color : {PlotColor::kAngle, PlotColor::kArea, PlotColor::kRegion, PlotColor::kPlain}) {
    plot_mesh({}, path, {.width = 300, .color = color});
    plot_mesh(one_point, path, {.width = 300, .color = color});
    plot_mesh(square_with_hole(), path, {.width = 300, .color = color, .box = PlotBox{{10, 10}, {11, 20}}});
    plot_mesh(square_with_hole(), path,
              {.width = 300, .color = color, .box = PlotBox{{0.5, 0.5}, {0.5 + 1e-9, 0.5 + 1e-9}}});
  }
  plot_pslg({}, path, {.width = 300});
  CHECK(Picture(path).width() == 300);
}

TEST_CASE("an input is drawn with its segments, holes and regions") {
  const TemporaryFolder folder;
  const std::string path = folder.path() / "input.png";
  Pslg pslg;
  pslg.points = {{0, 0}, {3, 0}, {3, 3}, {0, 3}, {1, 1}, {2, 1}, {2, 2}, {1, 2}};
  for (std::int32_t i = 0; i < 4; ++i) {
    pslg.segments.push_back({i, (i + 1) % 4, 1});
    pslg.segments.push_back({4 + i, 4 + (i + 1) % 4, 2});
  }
  pslg.holes = {{1.5, 1.5}};
  plot_pslg(pslg, path, {.width = 800, .height = 600});
  const Picture filled(path);
  pslg.segments.pop_back();  // now open: which side is inside is not known
  pslg.regions = {{{0.5, 0.5}, 3, 0.1}};
  plot_pslg(pslg, path, {.width = 800, .height = 600});
  const Picture open(path);
  CHECK(filled.drawn(0, 0, 800, 600) > open.drawn(0, 0, 800, 600) + 50000);
  CHECK(open.drawn(0, 0, 800, 600) > 2000);
}

TEST_CASE("a picture that cannot be written is an error and leaves nothing behind") {
  const TemporaryFolder folder;
  const Mesh mesh = square_with_hole();
  CHECK_THROWS_WITH_AS(plot_mesh(mesh, folder.path() / "a.gif", {}), doctest::Contains("ends in .png, .svg or .pdf"),
                       InputError);
  CHECK_THROWS_AS(plot_mesh(mesh, folder.path() / "a.png", {.width = 5}), InputError);
  CHECK_THROWS_AS(plot_mesh(mesh, folder.path() / "a.png", {.width = 1000000}), InputError);
  CHECK_THROWS_AS(plot_mesh(mesh, folder.path() / "missing" / "a.svg", {}), FileError);
  CHECK(std::filesystem::is_empty(folder.path()));
}

TEST_CASE("texts of pictures are spelled in ASCII for letters that have no more") {
  CHECK(ascii_text("plain 20.5") == "plain 20.5");
  CHECK(ascii_text("20\u00b0 to 2\u00b710\u207b\u00b3") == "20 deg to 2*10^-3");
  CHECK(ascii_text("10\u00b9\u2070, 10\u2074") == "10^10, 10^4");
  CHECK(ascii_text("S\u00f8r \u4e2d.") == "S?r ?.");
  CHECK(ascii_text("").empty());
}
