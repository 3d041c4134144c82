#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "driftmesh/adaptive.hpp"
#include "driftmesh/check.hpp"
#include "driftmesh/error.hpp"
#include "driftmesh/generate.hpp"
#include "driftmesh/size_on_mesh.hpp"
#include "oracles/random_pslg.hpp"
#include "support/error_text.hpp"
#include "support/mesh_equality.hpp"
#include "support/random.hpp"
#include "support/varied_domain.hpp"

// Meshes that follow lengths over many generations. The checker judges each of them by the lengths that the last one
// had been given, of which a second implementation limits the growth. A failure prints its seed.

using namespace driftmesh;
using testing::error_text;
using testing::mentions;
using testing::Random;
using testing::uniform;

namespace {

// Under the address sanitizer everything is several times slower.
#ifdef __SANITIZE_ADDRESS__
constexpr int kFewer = 4;
#else
constexpr int kFewer = 1;
#endif

Pslg square() {
  Pslg pslg;
  pslg.points = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  pslg.segments = {{0, 1, 1}, {1, 2, 2}, {2, 3, 3}, {3, 0, 4}};
  return pslg;
}

Box box_of(const Mesh& mesh) {
  return Box::of(mesh.points);
}

/// Rings and spots that move, as fronts do.
class Front {
 public:
  Front(Random& random, const Box& box) : size_(std::max(box.high.x - box.low.x, box.high.y - box.low.y)) {
    center_ = testing::somewhere_in(random, box);
    radius_ = uniform(random, 0, 0.5) * size_;
    speed_ = uniform(random, -0.05, 0.05) * size_;
    width_ = uniform(random, 0.01, 0.1) * size_;
    fine_ = size_ * std::exp2(uniform(random, -7, -5));
    coarse_ = size_ * std::exp2(uniform(random, -4, -2));
  }
  /// So that few subdomains have most of the triangles.
  void sharpen() {
    width_ *= 0.2;
    fine_ *= 0.25;
  }
  [[nodiscard]] double length(const Point& p, int generation) const {
    const double away = std::fabs(std::hypot(p.x - center_.x, p.y - center_.y) - radius_ - speed_ * generation);
    return away < width_ ? fine_ : std::min(coarse_, fine_ + 0.5 * (away - width_));
  }

 private:
  double size_;
  Point center_;
  double radius_, speed_, width_, fine_, coarse_;
};

std::vector<double> at_points(const Mesh& mesh, const std::function<double(const Point&)>& function) {
  std::vector<double> values;
  for (const Point& p : mesh.points) values.push_back(function(p));
  return values;
}

/// What the checker asks of the mesh after `before`.
MeshOptions judged_by(const MeshOptions& options, const SizeField& size) {
  MeshOptions judge = options;
  judge.size = [&size](const Point& p) { return size.edge_length(p); };
  judge.size_resolution = 1;  // what lies between corners and centroid has other tests
  return judge;
}

void check_stayed(const Mesh& before, const AdaptiveMesh& adaptive) {
  const Mesh& after = adaptive.mesh();
  const auto parents = adaptive.parents();
  REQUIRE(adaptive.stayed_points().size() == after.points.size());
  REQUIRE(adaptive.stayed_triangles().size() == after.triangles.size());
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < after.points.size(); ++i)
    if (const std::int32_t old = adaptive.stayed_points()[i]; old >= 0)
      wrong += !(before.points[old] == after.points[i]);
  for (std::size_t t = 0; t < after.triangles.size(); ++t) {
    const std::int32_t old = adaptive.stayed_triangles()[t];
    if (old < 0) continue;
    std::array<std::int32_t, 3> corners{};
    for (std::size_t i = 0; i < 3; ++i) corners[i] = adaptive.stayed_points()[after.triangles[t][i]];
    wrong += !std::is_permutation(corners.begin(), corners.end(), before.triangles[old].begin());
    wrong += std::ranges::count(parents.at(after.subdomains[t]), before.subdomains[old]) != 1;
  }
  CHECK(wrong == 0);
  std::set<std::int32_t> all;
  for (const auto& of_one : parents) all.insert(of_one.begin(), of_one.end());
  CHECK(all == std::set(before.subdomains.begin(), before.subdomains.end()));
}

/// All that stays is found: points at the same place, by a second search.
void check_all_found(const Mesh& before, const AdaptiveMesh& adaptive) {
  const auto less = [](const Point& a, const Point& b) { return a.x < b.x || (a.x == b.x && a.y < b.y); };
  std::vector<Point> old = before.points;
  std::ranges::sort(old, less);
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < adaptive.mesh().points.size(); ++i)
    wrong += std::ranges::binary_search(old, adaptive.mesh().points[i], less) != (adaptive.stayed_points()[i] >= 0);
  CHECK(wrong == 0);
}

}  // namespace

TEST_CASE("random domains follow random lengths over twenty generations") {
  std::int64_t divided = 0, joined = 0;
  for (int seed = 1; seed <= 4 / kFewer + 1; ++seed) {
    CAPTURE(seed);
    Random random(seed);
    const auto shape = oracles::make_random_shape(seed);
    const Pslg input = seed == 1 ? testing::varied_domain() : oracles::make_random_pslg(seed, shape).input;
    const double angles[] = {0, 15, 20, 28};
    const MeshOptions options{.min_angle = angles[random() % 4], .triangles = 500, .threads = 1};
    const AdaptiveOptions adaptive{.gradation = seed % 3 == 0 ? 0.0 : 0.3};
    AdaptiveMesh mesh(input, options, adaptive);
    const Box box = box_of(mesh.mesh());
    const auto plane = [&](const Point& p) {
      return 1 + (p.x - box.low.x) / (box.high.x - box.low.x) - 3 * (p.y - box.low.y) / (box.high.y - box.low.y);
    };
    Front front(random, box);
    if (seed % 2 == 0) front.sharpen();
    mesh.attach("plane", at_points(mesh.mesh(), plane));
    std::vector<double> marked(mesh.mesh().points.size());
    for (double& value : marked) value = uniform(random, -1, 1);
    mesh.attach("marked", marked);
    for (int generation = 1; generation <= 20; ++generation) {
      CAPTURE(generation);
      const Mesh before = mesh.mesh();
      const std::vector<double> lengths =
          at_points(before, [&](const Point& p) { return front.length(p, generation); });
      const std::vector<double> last(mesh.field("marked").begin(), mesh.field("marked").end());
      mesh.adapt(lengths);
      const auto size = size_on_mesh(before, lengths, adaptive.gradation);
      MeshOptions bounds = options;
      bounds.triangles = 0;
      const CheckReport report = check(mesh.mesh(), input, judged_by(bounds, *size));
      INFO(report.text);
      REQUIRE(report.accepted);
      check_stayed(before, mesh);
      check_all_found(before, mesh);
      double worst = 0, beyond = 0;
      const std::span<const double> planes = mesh.field("plane"), marks = mesh.field("marked");
      for (std::size_t i = 0; i < planes.size(); ++i) {
        worst = std::max(worst, std::fabs(planes[i] - plane(mesh.mesh().points[i])));
        beyond = std::max(beyond, std::fabs(marks[i]));
      }
      CHECK(worst < 1e-12 * generation);
      CHECK(beyond <= 1);
      std::size_t changed = 0;
      for (std::size_t i = 0; i < marks.size(); ++i)
        if (const std::int32_t old = mesh.stayed_points()[i]; old >= 0) changed += marks[i] != last[old];
      CHECK(changed == 0);
      divided += mesh.report().divided;
      joined += mesh.report().joined;
    }
  }
  CHECK(divided > 0);
  CHECK(joined > 0);
}

TEST_CASE("generations do not depend on the number of threads") {
  const auto ring = [](const Point& p, int g) {
    const double away = std::fabs(std::hypot(p.x - 0.5, p.y - 0.5) - 0.2 - 0.02 * g);
    return 0.01 + 0.2 * std::max(0.0, away - 0.03);
  };
  for (const int threads : {2, 4}) {
    CAPTURE(threads);
    AdaptiveMesh first(square(), {.max_area = 2e-3, .threads = 1});
    AdaptiveMesh many(square(), {.max_area = 2e-3, .threads = threads});
    for (AdaptiveMesh* mesh : {&first, &many})
      mesh->attach("u", at_points(mesh->mesh(), [](const Point& p) { return std::sin(9 * p.x) * p.y; }),
                   FieldPlace::kPoints, Transfer::kConserve);
    for (int g = 1; g <= 5; ++g) {
      CAPTURE(g);
      for (AdaptiveMesh* mesh : {&first, &many})
        mesh->adapt(at_points(mesh->mesh(), [&](const Point& p) { return ring(p, g); }));
      test::check_same_mesh(many.mesh(), first.mesh());
      CHECK(std::ranges::equal(many.field("u"), first.field("u")));
      CHECK(many.stayed_points() == first.stayed_points());
      CHECK(many.stayed_triangles() == first.stayed_triangles());
    }
  }
}

namespace {

double area_of(const Mesh& mesh, std::size_t t) {
  const Point &p = mesh.points[mesh.triangles[t][0]], &q = mesh.points[mesh.triangles[t][1]],
              &r = mesh.points[mesh.triangles[t][2]];
  return ((q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x)) / 2;
}

/// Integrals of a field and of its absolute values, and its range.
struct Summary {
  long double integral = 0, absolute = 0;
  double least = std::numeric_limits<double>::infinity(), most = -least;
};

Summary summary_of(const Mesh& mesh, FieldPlace place, std::span<const double> values) {
  Summary summary;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t i = 0; i < 3; ++i) {
      const double value = place == FieldPlace::kPoints      ? values[mesh.triangles[t][i]]
                           : place == FieldPlace::kTriangles ? values[t]
                                                             : values[3 * t + i];
      summary.integral += area_of(mesh, t) / 3 * value;
      summary.absolute += area_of(mesh, t) / 3 * std::fabs(value);
      summary.least = std::min(summary.least, value);
      summary.most = std::max(summary.most, value);
    }
  return summary;
}

}  // namespace

TEST_CASE("conserving transfer keeps integrals, bounds and constants") {
  std::int64_t divided = 0, joined = 0;
  for (int seed = 1; seed <= 5 / kFewer + 1; ++seed) {
    CAPTURE(seed);
    Random random(seed);
    const Pslg input =
        seed == 1 ? testing::varied_domain() : oracles::make_random_pslg(seed, oracles::make_random_shape(seed)).input;
    AdaptiveMesh mesh(input, {.triangles = 800, .threads = 1 + seed % 2});
    const Box box = box_of(mesh.mesh());
    Front front(random, box);
    if (seed % 2 == 0) front.sharpen();
    const std::size_t points = mesh.mesh().points.size(), triangles = mesh.mesh().triangles.size();
    const auto noise = [&](std::size_t count) {
      std::vector<double> values(count);
      for (double& value : values) value = uniform(random, -1, 1);
      return values;
    };
    const auto plane = [&](const Point& p) {
      return (p.x - box.low.x) / (box.high.x - box.low.x) - 2 * (p.y - box.low.y) / (box.high.y - box.low.y);
    };
    mesh.attach("points", noise(points), FieldPlace::kPoints, Transfer::kConserve);
    mesh.attach("triangles", noise(triangles), FieldPlace::kTriangles, Transfer::kConserve);
    mesh.attach("corners", noise(3 * triangles), FieldPlace::kCorners, Transfer::kConserve);
    mesh.attach("plane", at_points(mesh.mesh(), plane), FieldPlace::kPoints, Transfer::kConserve);
    std::vector<double> sloped;
    for (const auto& corners : mesh.mesh().triangles)
      for (const std::int32_t v : corners) sloped.push_back(plane(mesh.mesh().points[v]));
    mesh.attach("sloped", sloped, FieldPlace::kCorners, Transfer::kConserve);
    mesh.attach("one", std::vector<double>(triangles, 1), FieldPlace::kTriangles, Transfer::kConserve);
    mesh.attach("ones", std::vector<double>(3 * triangles, 1), FieldPlace::kCorners, Transfer::kConserve);
    const std::vector<std::pair<const char*, FieldPlace>> noisy{
        {"points", FieldPlace::kPoints}, {"triangles", FieldPlace::kTriangles}, {"corners", FieldPlace::kCorners}};
    for (int generation = 1; generation <= 10; ++generation) {
      CAPTURE(generation);
      const Mesh before = mesh.mesh();
      std::vector<Summary> old;
      for (const auto& [name, place] : noisy) old.push_back(summary_of(before, place, mesh.field(name)));
      const std::vector<double> last(mesh.field("triangles").begin(), mesh.field("triangles").end());
      mesh.adapt(at_points(before, [&](const Point& p) { return front.length(p, generation); }));
      for (std::size_t k = 0; k < noisy.size(); ++k) {
        CAPTURE(noisy[k].first);
        const Summary now = summary_of(mesh.mesh(), noisy[k].second, mesh.field(noisy[k].first));
        CHECK(std::fabs(static_cast<double>(now.integral - old[k].integral)) <
              1e-12 * static_cast<double>(old[k].absolute));
        CHECK(now.least > old[k].least - 1e-9);
        CHECK(now.most < old[k].most + 1e-9);
      }
      double worst = 0;
      for (std::size_t i = 0; i < mesh.mesh().points.size(); ++i)
        worst = std::max(worst, std::fabs(mesh.field("plane")[i] - plane(mesh.mesh().points[i])));
      CHECK(worst < 1e-11);
      double worst_corner = 0;
      for (std::size_t t = 0; t < mesh.mesh().triangles.size(); ++t)
        for (std::size_t i = 0; i < 3; ++i)
          worst_corner = std::max(worst_corner, std::fabs(mesh.field("sloped")[3 * t + i] -
                                                          plane(mesh.mesh().points[mesh.mesh().triangles[t][i]])));
      CHECK(worst_corner < 1e-8);  // projections add up
      for (const char* const name : {"one", "ones"}) {
        const auto [least, most] = std::ranges::minmax(mesh.field(name));
        CHECK(least > 1 - 1e-9);
        CHECK(most < 1 + 1e-9);
      }
      std::size_t changed = 0;
      for (std::size_t t = 0; t < mesh.mesh().triangles.size(); ++t)
        if (const std::int32_t from = mesh.stayed_triangles()[t]; from >= 0)
          changed += mesh.field("triangles")[t] != last[from];
      CHECK(changed == 0);
      divided += mesh.report().divided;
      joined += mesh.report().joined;
    }
  }
  CHECK(divided > 0);
  CHECK(joined > 0);
}

TEST_CASE("what is as it should be stays") {
  AdaptiveMesh mesh(square(), {.max_area = 1e-3, .threads = 1});
  const auto length = [](const Point& p) { return 0.02 + 0.1 * std::hypot(p.x - 0.3, p.y - 0.4); };
  mesh.adapt(at_points(mesh.mesh(), length));
  CHECK(mesh.report().mended + mesh.report().remade > 0);
  const Mesh before = mesh.mesh();
  mesh.adapt(std::vector<double>(before.points.size(), 0.5));
  const std::size_t coarse = mesh.mesh().triangles.size();
  mesh.adapt(std::vector<double>(mesh.mesh().points.size(), 0.5));
  CHECK(mesh.report().remade + mesh.report().mended == 0);
  CHECK(mesh.mesh().triangles.size() == coarse);
  CHECK(std::ranges::count(mesh.stayed_triangles(), -1) == 0);
  CHECK(std::ranges::count(mesh.stayed_points(), -1) == 0);
}

TEST_CASE("borders of subdomains are as fine as the bound on areas on either side asks") {
  int judged = 0;
  for (const bool fine_is_left : {true, false}) {
    CAPTURE(fine_is_left);
    constexpr double kFine = 2e-4;
    Pslg halves = square();
    halves.points.insert(halves.points.end(), {{0.5, 0}, {0.5, 1}});
    halves.segments = {{0, 4, 1}, {4, 1, 1}, {1, 2, 2}, {2, 5, 3}, {5, 3, 3}, {3, 0, 4}, {4, 5, 5}};
    halves.regions = {{{fine_is_left ? 0.25 : 0.75, 0.5}, 1, kFine}, {{fine_is_left ? 0.75 : 0.25, 0.5}, 2, 0}};
    AdaptiveMesh mesh(halves, {.max_area = 0.1, .threads = 1, .subdomains = {.count = 24}});
    for (const double length : {0.01, 0.5}) mesh.adapt(std::vector<double>(mesh.mesh().points.size(), length));
    CHECK(mesh.report().remade > 0);
    std::map<std::set<std::int32_t>, std::set<std::int32_t>> beside;  // the subdomains at each edge on the border
    for (std::size_t t = 0; t < mesh.mesh().triangles.size(); ++t)
      for (std::size_t i = 0; i < 3; ++i) {
        const auto a = mesh.mesh().triangles[t][i], b = mesh.mesh().triangles[t][(i + 1) % 3];
        if (mesh.mesh().points[a].x == 0.5 && mesh.mesh().points[b].x == 0.5)
          beside[{a, b}].insert(mesh.mesh().subdomains[t]);
      }
    for (const auto& [ends, subdomains] : beside) {
      if (subdomains.size() < 2) continue;
      ++judged;
      const double length = std::fabs(mesh.mesh().points[*ends.begin()].y - mesh.mesh().points[*ends.rbegin()].y);
      CHECK(length * length <= 4 / std::sqrt(3.0) * kFine);  // an edge of the equilateral triangle of that area
    }
  }
  CHECK(judged > 40);
}

TEST_CASE("a function of the place is followed, too") {
  AdaptiveMesh mesh(square(), {.max_area = 1e-2, .threads = 1});
  for (int g = 0; g < 4; ++g) {
    const auto size = [g](const Point& p) { return 0.02 + 0.3 * std::fabs(p.x - 0.2 * (g + 0.5)); };
    mesh.adapt(size);
    const CheckReport report = check(mesh.mesh(), square(), {.max_area = 1e-2, .size = size});
    INFO(report.text);
    CHECK(report.accepted);
  }
}

TEST_CASE("no more triangles than asked for") {
  AdaptiveMesh mesh(square(), {.threads = 1}, {.most_triangles = 30000});
  for (int g = 0; g < 3; ++g) {
    mesh.adapt(at_points(mesh.mesh(), [](const Point& p) { return 1e-4 + 0.05 * p.x; }));
    CHECK(mesh.report().scale > 1);
  }
  CHECK(mesh.mesh().triangles.size() < 33000);
  CHECK(mesh.mesh().triangles.size() > 24000);
}

TEST_CASE("no more triangles than asked for where lengths are different at each point, either") {
  AdaptiveMesh mesh(square(), {.max_area = 1e-3, .threads = 1}, {.gradation = 1, .most_triangles = 10000});
  std::mt19937 random(1);
  std::normal_distribution<double> spread;
  for (int g = 0; g < 5; ++g)
    mesh.adapt(at_points(mesh.mesh(), [&](const Point& /*p*/) { return 4e-3 * std::exp(spread(random)); }));
  CHECK(mesh.mesh().triangles.size() < 11000);
  CHECK(mesh.mesh().triangles.size() > 9000);
}

TEST_CASE("lengths from errors meet the target") {
  // The error of linear interpolation of x^4 + y^2, about.
  const auto error_of = [](const Mesh& mesh) {
    std::vector<double> errors;
    for (const auto& [a, b, c] : mesh.triangles) {
      const Point &p = mesh.points[a], &q = mesh.points[b], &r = mesh.points[c];
      const double area = ((q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x)) / 2;
      errors.push_back((12 * std::pow((p.x + q.x + r.x) / 3, 2) + 2) * area * std::sqrt(area));
    }
    return errors;
  };
  const auto total = [](const std::vector<double>& errors) {
    double sum = 0;
    for (const double e : errors) sum += e * e;
    return std::sqrt(sum);
  };
  AdaptiveMesh mesh(square(), {.max_area = 1e-3, .threads = 1});
  const double target = total(error_of(mesh.mesh())) / 10;
  for (int g = 0; g < 3; ++g) mesh.adapt(mesh.lengths_from_error(error_of(mesh.mesh()), target, 2));
  const std::vector<double> errors = error_of(mesh.mesh());
  CHECK(total(errors) < target);
  CHECK(total(errors) > target / 3);
}

TEST_CASE("wrong use is one clear error, and changes nothing") {
  AdaptiveMesh mesh(square(), {.max_area = 1e-2, .threads = 1});
  const std::size_t points = mesh.mesh().points.size();
  const auto adapted_by = [&](std::vector<double> lengths) { return error_text([&] { mesh.adapt(lengths); }); };
  CHECK(mentions(adapted_by(std::vector<double>(3, 1.0)),
                 {"there are 3 lengths for", "one for each point of the present mesh"}));
  for (const double wrong : {0.0, -1.0, std::nan("")}) {
    std::vector<double> lengths(points, 0.1);
    lengths[7] = wrong;
    CHECK(mentions(adapted_by(lengths), "the length at point 7 (counted from 0) is"));
  }
  CHECK(mentions(error_text([&] { mesh.attach("u", std::vector<double>(points + 1)); }),
                 {"'u'", "the same number for each"}));
  CHECK(mentions(
      error_text([&] { mesh.attach("u", std::vector<double>(mesh.mesh().triangles.size()), FieldPlace::kTriangles); }),
      {"'u'", "not interpolated"}));
  CHECK(mentions(error_text([&] { (void)mesh.field("v"); }), "no field 'v'"));
  CHECK(mentions(error_text([&] { mesh.detach("v"); }), "no field 'v'"));
  CHECK(mentions(error_text([&] { AdaptiveMesh(square(), {}, {.gradation = -1}); }), "gradation"));
  CHECK(mentions(error_text([&] { AdaptiveMesh(square(), {}, {.shortest = 2, .longest = 1}); }), "longest"));
  CHECK(mentions(error_text([&] { (void)mesh.lengths_from_error(std::vector<double>(2), 1); }), "2 indicators for"));
  const auto from_error = [&](double last, double target, double order) {
    std::vector<double> indicators(mesh.mesh().triangles.size(), 1.0);
    indicators.back() = last;
    return error_text([&] { (void)mesh.lengths_from_error(indicators, target, order); });
  };
  CHECK(from_error(0, 1, 2) == "no error");
  for (const double wrong : {-1.0, HUGE_VAL, std::nan("")}) {
    CHECK(
        mentions(from_error(wrong, 1, 2), "indicator of triangle " + std::to_string(mesh.mesh().triangles.size() - 1)));
    CHECK(mentions(from_error(1, wrong, 2), "target"));
    CHECK(mentions(from_error(1, 1, wrong), "order"));
  }
  CHECK(mentions(from_error(-1e-9, 1, 2), " is -1e-09; it must be at least 0"));
  CHECK(mentions(from_error(1, -1e-9, 2), "target is -1e-09; it must be positive"));
  CHECK(mentions(from_error(1, 0, 2), "target"));
  CHECK(mentions(from_error(1, 1, 0), "order"));

  const Mesh before = mesh.mesh();
  const auto nested = [&](const Point&) {
    mesh.adapt(std::vector<double>(points, 0.1));
    return 0.1;
  };
  CHECK(mentions(error_text([&] { mesh.adapt(nested); }), "called by a function that adapt calls"));
  struct Refusal {};
  int calls = 0;
  CHECK_THROWS_AS(mesh.adapt([&](const Point&) { return ++calls > 2000 ? throw Refusal() : 0.01; }), Refusal);
  test::check_same_mesh(mesh.mesh(), before);
  CHECK(mesh.report().generation == 0);
  mesh.adapt(std::vector<double>(points, 0.05));
  CHECK(mesh.report().generation == 1);
}

TEST_CASE("a limit stops a generation, and changes nothing") {
  AdaptiveMesh mesh(square(), {.max_area = 1e-2, .threads = 2, .max_triangles = 10000});
  const Mesh before = mesh.mesh();
  CHECK_THROWS_AS(mesh.adapt(std::vector<double>(before.points.size(), 1e-3)), LimitError);
  test::check_same_mesh(mesh.mesh(), before);
}

TEST_CASE("what cannot be summed up is refused before anything changes, where integrals are to stay") {
  AdaptiveMesh mesh(square(), {.max_area = 1e-2, .threads = 2});
  const Mesh before = mesh.mesh();
  const std::vector<double> lengths(before.points.size(), 0.05);
  mesh.attach("u", std::vector<double>(before.points.size(), 1), FieldPlace::kPoints, Transfer::kConserve);
  for (const double wrong : {std::nan(""), HUGE_VAL, -1e300}) {
    mesh.field("u")[7] = wrong;
    CHECK(mentions(error_text([&] { mesh.adapt(lengths); }), {"field 'u' is", "at point 7", "conserved"}));
    test::check_same_mesh(mesh.mesh(), before);
  }
  mesh.field("u")[7] = 1;
  mesh.adapt(lengths);
  CHECK(mesh.report().generation == 1);
}

TEST_CASE("a front that moves to and fro leaves no trace") {
  // Subdomains are mended, not made anew; what they lose and gain again must not make them denser.
  const auto size = [](int g) {
    return [g](const Point& p) {
      const double shift = 0.004 * (g % 10 < 5 ? g % 10 : 10 - g % 10);
      const double away = std::fabs(std::hypot(p.x - 0.4, p.y - 0.5) - 0.2 - shift);
      return 0.004 + 0.2 * std::max(0.0, away - 0.03);
    };
  };
  AdaptiveMesh mesh(square(), {.size = size(0), .threads = 1});
  std::int32_t mended = 0;
  for (int g = 1; g <= 20; ++g) {
    const Mesh before = mesh.mesh();
    const std::vector<double> lengths = at_points(before, size(g));
    mesh.adapt(lengths);
    mended += mesh.report().mended;
    if (g != 15 && g != 20) continue;
    CAPTURE(g);
    const auto judge = size_on_mesh(before, lengths, 0.2);
    const CheckReport report = check(mesh.mesh(), square(), judged_by({}, *judge));
    INFO(report.text);
    REQUIRE(report.accepted);
    check_stayed(before, mesh);
    check_all_found(before, mesh);
    const MeshOptions fresh{
        .size = [&](const Point& p) { return judge->edge_length(p); }, .size_resolution = 100, .threads = 1};
    const auto expected = static_cast<double>(AdaptiveMesh(square(), fresh).mesh().triangles.size());
    CHECK(static_cast<double>(mesh.mesh().triangles.size()) < 1.03 * expected);
    CHECK(static_cast<double>(mesh.mesh().triangles.size()) > 0.97 * expected);
  }
  CHECK(mended > 100);
}
