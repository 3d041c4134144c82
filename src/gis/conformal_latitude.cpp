#include "gis/conformal_latitude.hpp"

#include <cmath>

namespace driftmesh {

double conformal_tangent(double tangent) {
  const double eccentricity = std::sqrt(kFlattening * (2 - kFlattening));
  const double sigma = std::sinh(eccentricity * std::atanh(eccentricity * tangent / std::hypot(1, tangent)));
  return tangent * std::hypot(1, sigma) - sigma * std::hypot(1, tangent);
}

double tangent_of_conformal(double conformal) {
  constexpr double kE2 = kFlattening * (2 - kFlattening);
  double tangent = conformal / (1 - kE2);
  for (int i = 0; i < 6; ++i) {
    const double found = conformal_tangent(tangent);
    const double step = (conformal - found) / std::hypot(1, found) * (1 + (1 - kE2) * tangent * tangent) /
                        ((1 - kE2) * std::hypot(1, tangent));
    tangent += step;
    if (std::abs(step) < 1e-16 * (1 + std::abs(tangent))) break;
  }
  return tangent;
}

}  // namespace driftmesh
