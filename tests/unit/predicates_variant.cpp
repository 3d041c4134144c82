// Compiled with -DVARIANT=name -Ddriftmesh=another_name: a copy of the predicates beside those of the library.
#include "predicates_variant.hpp"

#include "geometry/predicates.cpp"

namespace VARIANT {

double product_difference(double a, double b, double c, double d) {
  return a * b - c * d;
}

double incircle_exact(const std::array<double, 8>& xy) {
  return driftmesh::incircle_exact({xy[0], xy[1]}, {xy[2], xy[3]}, {xy[4], xy[5]}, {xy[6], xy[7]});
}

}  // namespace VARIANT
