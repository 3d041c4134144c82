#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "driftmesh/error.hpp"
#include "mesh/domain_outline.hpp"
#include "property/cases.hpp"
#include "sizing/background_function.hpp"
#include "sizing/expression_field.hpp"
#include "sizing/make_size_field.hpp"
#include "support/made_mesh.hpp"
#include "support/random.hpp"
#include "temporary_folder.hpp"
#include "unit/sizing_mesh_fixture.hpp"

// Size fields with random narrow features. What they ask for is looked up again by dense sampling of the finished mesh,
// which knows where the features are.

using namespace driftmesh;
using namespace driftmesh::testing;

namespace {

using Corner = std::array<Point, 3>;

std::string text_of(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "(%.17g)", value);
  return text;
}

Point random_point(Random& random) {
  return {uniform(random, 0.02, 0.98), uniform(random, 0.02, 0.98)};
}

Pslg unit_square() {
  Pslg pslg;
  pslg.points = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  pslg.segments = {{0, 1, 1}, {1, 2, 1}, {2, 3, 1}, {3, 0, 1}};
  return pslg;
}

/// The triangles of a domain with these sizes. Subdomains that do not conform throw.
std::vector<Corner> meshed(const job::Request::Sizing& sizing, std::int32_t subdomains = 1,
                           const SizeField* size = nullptr, const Pslg& domain = unit_square()) {
  job::Request request;
  request.sizing = sizing;
  request.decomposition.subdomains = subdomains;
  request.limits.max_triangles = 2'000'000;
  const Mesh mesh = made(domain, request, size).mesh;
  std::vector<Corner> all;
  for (const auto& [a, b, c] : mesh.triangles) all.push_back({mesh.points[a], mesh.points[b], mesh.points[c]});
  return all;
}

/// A background mesh in files.
class BackgroundFiles {
 public:
  explicit BackgroundFiles(const FlatMesh& mesh, const std::vector<double>& lengths = {}) {
    std::string nodes = std::to_string(mesh.points.size()) + (lengths.empty() ? " 2 0 0\n" : " 2 1 0\n");
    for (std::size_t i = 0; i < mesh.points.size(); ++i)
      nodes += line({mesh.points[i].x, mesh.points[i].y, lengths.empty() ? 0 : lengths[i]}, i, lengths.empty() ? 2 : 3);
    std::string triangles = std::to_string(mesh.triangles.size()) + " 3 0\n";
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      triangles += std::to_string(t);
      for (const std::int32_t corner : mesh.triangles[t]) triangles += " " + std::to_string(corner);
      triangles += "\n";
    }
    write("node", nodes);
    write("ele", triangles);
  }
  void add_areas(const std::vector<double>& areas) const {
    std::string text = std::to_string(areas.size()) + "\n";
    for (std::size_t t = 0; t < areas.size(); ++t) text += line({areas[t], 0, 0}, t, 1);
    write("area", text);
  }
  [[nodiscard]] std::string file(const std::string& extension) const {
    return (folder_.path() / ("background." + extension)).string();
  }

 private:
  static std::string line(const std::array<double, 3>& values, std::size_t number, std::size_t count) {
    std::string text = std::to_string(number);
    char value[40];
    for (std::size_t k = 0; k < count; ++k) {
      std::snprintf(value, sizeof value, " %.17g", values[k]);
      text += value;
    }
    return text + "\n";
  }
  void write(const std::string& extension, const std::string& text) const { std::ofstream(file(extension)) << text; }

  TemporaryFolder folder_;
};

double cross(const Point& a, const Point& b, const Point& p) {
  return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
}

bool holds(const Corner& t, const Point& p) {
  return cross(t[0], t[1], p) >= 0 && cross(t[1], t[2], p) >= 0 && cross(t[2], t[0], p) >= 0;
}

/// The edge of the equilateral triangle of the same area.
double edge_of(const Corner& t) {
  return std::sqrt(cross(t[0], t[1], t[2]) * 2 / std::sqrt(3.0));
}

/// By how much an edge is longer than it should be, at worst, at these points and at some of every triangle.
double worst_excess(const std::vector<Corner>& mesh, const std::function<double(const Point&)>& size,
                    const std::vector<Point>& features, Random& random) {
  double worst = 0;
  for (const Corner& t : mesh) {
    const double edge = edge_of(t);
    for (int k = 0; k < 30; ++k) {
      const double u = uniform(random, 0, 1), v = uniform(random, 0, 1 - u), w = 1 - u - v;
      const Point p{u * t[0].x + v * t[1].x + w * t[2].x, u * t[0].y + v * t[1].y + w * t[2].y};
      worst = std::max(worst, edge / size(p));
    }
  }
  for (const Point& p : features) {
    const double asked = size(p);
    for (const Corner& t : mesh)
      if (holds(t, p)) worst = std::max(worst, edge_of(t) / asked);
  }
  return worst;
}

struct Feature {
  std::string expression;
  std::vector<Point> points;
};

/// A bump, a crease or a spot, much narrower than the triangles around it.
Feature random_feature(Random& random) {
  const Point c = random_point(random);
  const std::string far = text_of(uniform(random, 0.1, 0.4));
  const double least = std::exp(uniform(random, std::log(0.003), std::log(0.03)));
  const double width = std::exp(uniform(random, std::log(1e-5), std::log(0.02)));
  const std::string x = "(x-" + text_of(c.x) + ")", y = "(y-" + text_of(c.y) + ")";
  Feature feature;
  feature.points.push_back(c);
  switch (random() % 3) {
    case 0:
      feature.expression =
          far + "-(" + far + "-" + text_of(least) + ")*exp(-(" + x + "^2+" + y + "^2)/" + text_of(width * width) + ")";
      for (int k = 0; k < 20; ++k)
        feature.points.push_back({c.x + uniform(random, -width, width), c.y + uniform(random, -width, width)});
      break;
    case 1: {
      const double a = uniform(random, 0, 3.14159), dx = std::cos(a), dy = std::sin(a);
      feature.expression = "min(" + far + "," + text_of(least) + "+" + text_of(uniform(random, 1, 12)) + "*abs(" +
                           text_of(dy) + "*" + x + "-" + text_of(dx) + "*" + y + "))";
      for (int k = 0; k < 200; ++k) {
        const double along = uniform(random, -1.4, 1.4);
        const Point p{c.x + along * dx, c.y + along * dy};
        if (p.x > 0 && p.x < 1 && p.y > 0 && p.y < 1) feature.points.push_back(p);
      }
      break;
    }
    default:
      feature.expression = "hypot(" + x + "," + y + ")<" + text_of(width) + " ? " + text_of(least) + " : " + far;
  }
  return feature;
}

constexpr double kTolerance = 1.25 * (1 + 1e-6);  // lengths are kept in single precision

/// As it is compiled for meshes of the unit square, or exactly.
std::unique_ptr<SizeField> size_of(const std::string& expression, std::optional<double> gradation = {},
                                   bool exact = false, const Pslg* input = nullptr) {
  SizingOptions options{
      .expression = expression, .gradation = gradation, .spacing = 1.0 / 2000, .domain = {{0, 0}, {1, 1}}};
  options.input = input;
  if (input != nullptr) options.outline = [input] { return domain_outline(*input); };
  options.exact = exact;
  return make_size_field(options);
}

}  // namespace

TEST_CASE("no feature of an expression is missed, however narrow") {
  Random random = seeded_generator("features of expressions");
  for (int i = 0; i < case_count(150); ++i) {
    const Feature feature = random_feature(random);
    CAPTURE(feature.expression);
    const ExpressionField asked(feature.expression);
    const auto size = [&](const Point& p) { return asked.edge_length(p); };
    const job::Request::Sizing sizing{.expression = feature.expression, .background = {}};
    CHECK(worst_excess(meshed(sizing), size, feature.points, random) <= kTolerance);
    if (i % 5 == 0) CHECK(worst_excess(meshed(sizing, 6), size, feature.points, random) <= kTolerance);
  }
}

TEST_CASE("the growth of an expression is limited around every feature, however narrow") {
  Random random = seeded_generator("graded expressions");
  for (int i = 0; i < case_count(40); ++i) {
    const Feature feature = random_feature(random);
    CAPTURE(feature.expression);
    const double gradation = uniform(random, 0.1, 0.5);
    CAPTURE(gradation);
    const ExpressionField plain(feature.expression);
    const auto field = size_of(feature.expression, gradation), exact = size_of(feature.expression, gradation, true);
    for (int k = 0; k < 50; ++k) {
      const Point p = random_point(random);
      double most = plain.edge_length(p);
      for (const Point& q : feature.points)
        most = std::min(most, plain.edge_length(q) + gradation * std::hypot(p.x - q.x, p.y - q.y));
      CHECK(exact->edge_length(p) <= most / 0.97 * (1 + 1e-9));
      CHECK(field->edge_length(p) <= most * 1.16);
      const Point q = random_point(random);
      const double from_q = 0.97 * exact->edge_length(q) - gradation * std::hypot(p.x - q.x, p.y - q.y);
      CHECK(exact->edge_length(p) >= std::min(0.9 * plain.edge_length(p), from_q - 1e-9));
      CHECK(field->edge_length(p) >= 0.75 * exact->edge_length(p));
    }
  }
}

TEST_CASE("a mesh of an expression whose growth is limited") {
  Random random(5);
  const std::string bump = "0.3-0.29*exp(-((x-.6)^2+(y-.3)^2)*1e6)";
  const auto exact = size_of(bump, 0.25, true);
  const auto size = [&](const Point& p) { return exact->edge_length(p); };
  const job::Request::Sizing sizing{.expression = bump, .background = {}, .gradation = 0.25};
  CHECK(worst_excess(meshed(sizing), size, {{0.6, 0.3}}, random) <= kTolerance);
}

TEST_CASE("no feature of a function is missed that is wider than the spacing of its samples") {
  struct Spot final : SizeField {
    Point center{};
    double radius = 0, inside = 0, outside = 0;
    [[nodiscard]] double edge_length(const Point& p) const override {
      CHECK((p.x >= 0 && p.x <= 1 && p.y >= 0 && p.y <= 1));
      return std::hypot(p.x - center.x, p.y - center.y) <= radius ? inside : outside;
    }
  };
  Random random = seeded_generator("features of functions");
  for (int i = 0; i < case_count(60); ++i) {
    const auto resolution = static_cast<std::int64_t>(20 + random() % 380);
    const double spacing = 1 / static_cast<double>(resolution);
    Spot spot;
    spot.center = random_point(random);
    spot.radius = spacing * uniform(random, 0.71, 1.5);  // a square of the spacing fits in
    spot.inside = spot.radius * uniform(random, 0.2, 1);
    spot.outside = uniform(random, 0.1, 0.5);
    CAPTURE(spacing);
    CAPTURE(spot.center.x);
    CAPTURE(spot.center.y);
    CAPTURE(spot.radius);
    const job::Request::Sizing sizing{.expression = {}, .background = {}, .resolution = resolution};
    const std::vector<Corner> mesh = meshed(sizing, i % 4 != 0 ? 1 : 5, &spot);
    double smallest = 1;
    for (const Corner& t : mesh)
      if (std::hypot(t[0].x - spot.center.x, t[0].y - spot.center.y) < 3 * spot.radius)
        smallest = std::min(smallest, edge_of(t));
    CHECK(smallest <= spot.inside / 0.9);
  }
}

TEST_CASE("no length of a background mesh is missed") {
  Random random = seeded_generator("features of background meshes");
  for (int i = 0; i < case_count(60); ++i) {
    const int n = static_cast<int>(5 + random() % 60);
    CAPTURE(n);
    FlatMesh flat = square_mesh(n, 0, true, random());
    for (Point& p : flat.points) p = {1.2 * p.x / n - 0.1, 1.2 * p.y / n - 0.1};
    const double far = uniform(random, 0.1, 0.4);
    std::vector<double> lengths(flat.points.size(), far);
    for (int k = 0; k < 4; ++k) lengths[random() % lengths.size()] = far * std::exp(uniform(random, -4, -1));
    const auto field =
        BackgroundFunction::of_points(std::make_shared<const BackgroundMesh>(flat.points, flat.triangles), lengths);
    const auto size = [&](const Point& p) { return field->at(p); };
    const BackgroundFiles files(flat, lengths);
    const job::Request::Sizing sizing{.expression = {}, .background = files.file("node")};
    const std::vector<Corner> mesh = meshed(sizing, i % 4 != 0 ? 1 : 5);
    CHECK(worst_excess(mesh, size, flat.points, random) <= kTolerance);
  }
}

TEST_CASE("area bounds of a background mesh are kept wherever their triangles are") {
  Random random = seeded_generator("area bounds of background meshes");
  for (int i = 0; i < case_count(40); ++i) {
    const int n = static_cast<int>(5 + random() % 30);
    CAPTURE(n);
    FlatMesh flat = square_mesh(n, 0, true, random());
    for (Point& p : flat.points) p = {1.2 * p.x / n - 0.1, 1.2 * p.y / n - 0.1};
    std::vector<double> areas(flat.triangles.size(), -1);
    std::vector<Point> inside;
    for (int k = 0; k < 4; ++k) {
      const std::size_t t = random() % areas.size();
      areas[t] = std::exp(uniform(random, -11, -5));
      const auto& [a, b, c] = flat.triangles[t];
      const Point &p = flat.points[a], &q = flat.points[b], &r = flat.points[c];
      inside.push_back({(p.x + q.x + r.x) / 3, (p.y + q.y + r.y) / 3});
      inside.push_back({0.98 * p.x + 0.01 * (q.x + r.x), 0.98 * p.y + 0.01 * (q.y + r.y)});
    }
    const auto field =
        BackgroundFunction::of_areas(std::make_shared<const BackgroundMesh>(flat.points, flat.triangles), areas);
    const auto size = [&](const Point& p) { return field->at(p); };
    const BackgroundFiles files(flat);
    files.add_areas(areas);
    const job::Request::Sizing sizing{.expression = {}, .background = files.file("area")};
    CHECK(worst_excess(meshed(sizing), size, inside, random) <= kTolerance);
  }
}

namespace {

/// A closed line with bays, in the unit square.
Pslg random_outline(Random& random) {
  const int count = static_cast<int>(5 + random() % 60);
  Pslg pslg;
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * 3.14159265358979 * i / count, radius = uniform(random, 0.25, 0.48);
    pslg.points.push_back({0.5 + radius * std::cos(angle), 0.5 + radius * std::sin(angle)});
    pslg.segments.push_back({i, (i + 1) % count, static_cast<std::int32_t>(1 + random() % 2)});
  }
  pslg.segments.front().marker = 1;
  return pslg;
}

/// A rule of distances, a jump, or what changes everywhere.
std::string random_size_rule(Random& random) {
  const auto number = [&](double low, double high) { return text_of(uniform(random, low, high)); };
  const std::string near = number(0.004, 0.01), far = number(0.03, 0.08);
  switch (random() % 6) {
    case 5:
      return "max(" + near + ",min(" + far + ",width()/" + number(2, 8) + "))";
    case 0:
      return near + "+" + number(0.03, 0.25) + "*distance()";
    case 1:
      return "min(" + far + "," + near + "+" + number(0.05, 0.4) + "*distance(1))";
    case 2:
      return "distance(1)<" + number(0.01, 0.05) + " ? " + near + " : " + far;
    case 3:
      return "x<" + number(0.3, 0.7) + " ? " + near + " : " + far;
    default:
      return near + "+" + number(0.02, 0.1) + "*hypot(x-" + number(0, 1) + ",y-" + number(0, 1) + ")+0.002*sin(20*x)^2";
  }
}

}  // namespace

TEST_CASE("the outline of a domain has the domain to its left, and no segments inside") {
  Pslg domain = unit_square();
  domain.points.insert(domain.points.end(), {{0.4, 0.4}, {0.6, 0.4}, {0.6, 0.6}, {0.4, 0.6}, {0.1, 0.2}, {0.9, 0.2}});
  for (const auto& [a, b] : {std::pair{4, 5}, {6, 5}, {6, 7}, {4, 7}, {8, 9}}) domain.segments.push_back({a, b, 2});
  domain.holes = {{0.5, 0.5}};
  const OutlineSegments outline = domain_outline(domain);
  CHECK(outline.size() == 8);
  double area = 0;
  for (const auto& [a, b] : outline) area += (a.x * b.y - a.y * b.x) / 2;
  CHECK(area == doctest::Approx(1 - 0.04));
}

TEST_CASE("a part of the width puts as many triangles across a channel") {
  Random random = seeded_generator("triangles across");
  for (int i = 0; i < case_count(12); ++i) {
    const double wide = uniform(random, 0.02, 0.2), slope = uniform(random, -0.6, 0.6);
    const int count = 2 + static_cast<int>(random() % 5);
    CAPTURE(wide);
    CAPTURE(slope);
    CAPTURE(count);
    Pslg domain;  // a basin, and a channel that leads out of it
    domain.points = {{-0.5, -0.5},      {0, -0.5}, {0, 0},          {1, slope},
                     {1, slope + wide}, {0, wide}, {0, wide + 0.5}, {-0.5, wide + 0.5}};
    for (std::int32_t k = 0; k < 8; ++k) domain.segments.push_back({k, (k + 1) % 8, 1});
    const std::vector<Corner> mesh =
        meshed({.expression = "width()/" + std::to_string(count), .background = {}}, 1, nullptr, domain);
    for (int k = 0; k < 50; ++k) {
      const double x = uniform(random, 0.05, 0.95);
      const auto across = std::ranges::count_if(mesh, [x](const Corner& t) {
        const auto [low, high] = std::minmax({t[0].x, t[1].x, t[2].x});
        return low < x && x < high;
      });
      CHECK(across >= count);
    }
    CHECK(mesh.size() < 60.0 * count * count * (1 / wide + 40));
  }
}

TEST_CASE("in any outline no triangle is larger than a rule asks for, and meshes have hardly more than that takes") {
  Random random = seeded_generator("rules in outlines");
  double made = 0, needed = 0;
  for (int i = 0; i < case_count(16); ++i) {
    const Pslg domain = random_outline(random);
    const std::string rule = random_size_rule(random);
    std::optional<double> gradation;
    if (random() % 2 == 0) gradation = uniform(random, 0.1, 0.35);
    CAPTURE(i);
    CAPTURE(rule);
    CAPTURE(gradation.value_or(0));
    const auto exact = size_of(rule, gradation, true, &domain);
    const std::vector<Corner> mesh = meshed({.expression = rule, .background = {}, .gradation = gradation.value_or(0)},
                                            1, nullptr, domain),
                              other = meshed({}, 1, exact.get(), domain);
    const auto size = [&](const Point& p) { return exact->edge_length(p); };
    CHECK(worst_excess(mesh, size, {}, random) <= kTolerance);
    made += static_cast<double>(mesh.size());
    needed += static_cast<double>(other.size());
    CHECK(static_cast<double>(mesh.size()) <= 1.1 * static_cast<double>(other.size()) + 200);
  }
  CHECK(made <= 1.03 * needed);
}
