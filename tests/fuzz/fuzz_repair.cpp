// Bytes become a small planar straight line graph with coordinates that coincide, nearly coincide or overlap: after
// repair, exact tests of all pairs must find it planar.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "driftmesh/error.hpp"
#include "driftmesh/repair.hpp"
#include "geometry/predicates.hpp"

namespace {

using namespace driftmesh;

/// Bytes one by one; zeros after the end.
class Bytes {
 public:
  Bytes(const std::uint8_t* data, std::size_t size) : at_(data), end_(data + size) {}
  int next() { return at_ == end_ ? 0 : *at_++; }

 private:
  const std::uint8_t* at_;
  const std::uint8_t* end_;
};

// An integer from 0 to 15, in one of several units, a few units in the last place off.
double coordinate(Bytes& bytes) {
  constexpr double kUnits[] = {1, 0.1, 1.0 / 3, 1e6 / 7};
  const int code = bytes.next(), off = bytes.next();
  double value = (code & 15) * kUnits[code >> 4 & 3];
  for (int i = 0; i < (off & 7); ++i) value = std::nextafter(value, off & 8 ? 1e9 : -1e9);
  return in_input_range(value) ? value : 0;
}

Pslg decode(Bytes& bytes) {
  Pslg pslg;
  const std::int32_t points = 3 + bytes.next() % 30;
  for (std::int32_t i = 0; i < points; ++i) {
    const double x = coordinate(bytes);
    pslg.points.push_back({x, coordinate(bytes)});
  }
  for (int count = bytes.next() % 40; count > 0; --count) {
    const std::int32_t a = bytes.next() % points;
    pslg.segments.push_back({a, bytes.next() % points, 0});
  }
  return pslg;
}

void require(bool condition) {
  if (!condition) std::abort();
}

bool between(const Point& p, const Point& a, const Point& b) {
  return std::fmin(a.x, b.x) <= p.x && p.x <= std::fmax(a.x, b.x) && std::fmin(a.y, b.y) <= p.y &&
         p.y <= std::fmax(a.y, b.y);
}

int sign(double v) {
  return (v > 0) - (v < 0);
}

void require_planar(const Pslg& pslg) {
  const auto& p = pslg.points;
  for (const Pslg::Segment& s : pslg.segments) {
    const auto a = static_cast<std::size_t>(s.a), b = static_cast<std::size_t>(s.b);
    require(!(p[a] == p[b]));
    for (std::size_t v = 0; v < p.size(); ++v)
      require(v == a || v == b || orient2d(p[a], p[b], p[v]) != 0 || !between(p[v], p[a], p[b]));
    for (const Pslg::Segment& t : pslg.segments) {
      const auto c = static_cast<std::size_t>(t.a), d = static_cast<std::size_t>(t.b);
      require(&s == &t || !((a == c && b == d) || (a == d && b == c)));
      if (a == c || a == d || b == c || b == d) continue;
      require(sign(orient2d(p[a], p[b], p[c])) * sign(orient2d(p[a], p[b], p[d])) >= 0 ||
              sign(orient2d(p[c], p[d], p[a])) * sign(orient2d(p[c], p[d], p[b])) >= 0);
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Bytes bytes(data, size);
  Pslg pslg = decode(bytes);
  try {
    (void)repair(pslg);
  } catch (const InputError&) {
    return 0;  // collinear points, or segments a few units in the last place apart that rounding keeps moving
  }
  require_planar(pslg);
  require(!repair(pslg).changed());
  return 0;
}
