// Text as a size expression: if it is one, its values lie in the intervals of boxes around them.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "driftmesh/error.hpp"
#include "sizing/expression.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace driftmesh;
  Pslg pslg;
  pslg.points = {{0, 0}, {1, 0}, {0, 1}};
  pslg.segments = {{0, 1, 1}, {1, 2, -2}};
  try {
    const Expression expression(std::string(reinterpret_cast<const char*>(data), size), &pslg);
    for (const Point& p : {Point{0, 0}, {1, -1}, {0.3, 0.7}, {-40, 1e5}})
      for (const double margin : {0.0, 0.125, 10.0}) {
        const Interval range = expression.over(Box::around(p, p, margin)).value;
        const double value = expression.at(p);
        if (std::isnan(value) ? !range.undefined : !range.holds(value)) std::abort();
      }
  } catch (const InputError&) {
  }
  return 0;
}
