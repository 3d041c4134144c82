#include "verify/polygons_check.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "base/formatted.hpp"
#include "driftmesh/id_vector.hpp"
#include "verify/arrangement.hpp"
#include "verify/cut_rings.hpp"
#include "verify/words.hpp"

namespace driftmesh {
namespace {

double attribute_of(const Domain& domain, std::int32_t face) {
  const Pslg::Region* const region = domain.region_of(face);
  return region != nullptr ? region->attribute : 0;
}

class PolygonsCheck {
 public:
  PolygonsCheck(const Domain& domain, const Domain& given, double moved, Findings& findings)
      : domain_(domain),
        given_(given),
        findings_(findings),
        tolerance_(domain.border_tolerance() + given.border_tolerance() +
                   2 * moved * (domain.border_length() + given.border_length())),
        explains_(moved > 0 ? "what was snapped and simplified" : "rounding") {}

  void check_face(std::int32_t face, const Point& place, std::int32_t given_face) {
    if (given_face == Arrangement::kOnBoundary) return;
    const auto say = [&](const std::string& what) {
      findings_.add(Flaw::kWrongPolygons, [&] {
        return formatted("the face of area {:.9g} around {} {}", domain_.area(face), place_words(place), what);
      });
    };
    if (!given_.inside(given_face))
      say("lies in no polygon of the input");
    else if (const double actual = attribute_of(domain_, face), expected = attribute_of(given_, given_face);
             actual != expected)
      say(formatted("belongs to region {}, by the polygons of the input to {}", actual, expected));
  }

  void check_areas() {
    check_area("the domain", domain_.area(), given_.area());
    std::map<double, double> actual = domain_.areas_of_regions(), expected = given_.areas_of_regions();
    for (const auto& [region, area] : expected) actual.try_emplace(region, 0);
    for (const auto& [region, area] : actual) check_area(formatted("region {}", region), area, expected[region]);
  }

 private:
  void check_area(const std::string& what, double actual, double expected) {
    if (std::fabs(actual - expected) <= tolerance_) return;
    findings_.add(Flaw::kWrongPolygons, [&] {
      return formatted("the area of {} is {:.17g}, by the polygons of the input {:.17g} ({} explains {:.3g})", what,
                       actual, expected, explains_, tolerance_);
    });
  }

  const Domain& domain_;
  const Domain& given_;
  Findings& findings_;
  double tolerance_;
  const char* explains_;  // it
};

}  // namespace

bool same_polygons(const Pslg& given, const Pslg& repaired) {
  const auto are_same = [](const Pslg& a, const Pslg& b) {
    return a.points == b.points && a.polygons == b.polygons && a.regions == b.regions;
  };
  if (are_same(given, repaired)) return true;
  const std::optional<Pslg> rings = rings_alone(given), others = rings_alone(repaired);
  return rings && others && are_same(*rings, *others);
}

bool has_seeds(const Pslg& input) {
  std::vector<char> named(input.regions.size());
  for (const Pslg::Polygon& polygon : input.polygons)
    if (to_index(polygon.region) < named.size()) named[polygon.region] = 1;
  return std::ranges::find(named, 0) != named.end();
}

bool check_polygons(const Pslg& input, const Domain& domain, const std::vector<std::optional<Point>>& places,
                    double moved, Findings& findings) {
  std::optional<Pslg> rings = rings_alone(input);
  if (!rings) return false;
  std::vector<std::int32_t> faces;
  std::vector<Point> known;
  for (const std::int32_t face : first_ids<std::int32_t>(places.size()))
    if (places[face] && moved == 0) {
      faces.push_back(face);
      known.push_back(*places[face]);
    }
  Domain given(*rings, HoleRule::kPoints, known);
  if (given.conflict()) {
    rings = cut_rings(std::move(*rings));
    if (!rings) return false;
    given = Domain(*rings, HoleRule::kPoints, known);
    if (given.conflict()) return false;
  }
  PolygonsCheck check(domain, given, moved, findings);
  for (std::size_t i = 0; i < faces.size(); ++i) check.check_face(faces[i], known[i], given.face_of_place(i));
  check.check_areas();
  return true;
}

}  // namespace driftmesh
