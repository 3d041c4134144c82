#pragma once

#include "sizing/interval.hpp"

namespace driftmesh {

// Waves on water, with lengths in meters, times in seconds and kGravity in m/s^2.

inline constexpr double kGravity = 9.81;

/// The length of waves of a period: that L for which L = g T^2 / (2 pi) tanh(2 pi h / L), the dispersion relation of
/// linear waves, to some units in the last place. Rises with depth and period. 0 where one of them is 0, NaN below.
[[nodiscard]] double wavelength(double depth, double period);
[[nodiscard]] Interval wavelength_over(const Interval& depth, const Interval& period);
/// From the slopes of depth and period.
[[nodiscard]] Interval wavelength_slope(const Interval& depth, const Interval& period, const Interval& of_depth,
                                        const Interval& of_period);

/// The edge length at which the Courant number of waves that travel with a current of this speed, in m/s, is `bound`:
/// dt (sqrt(g h) + speed) / bound. Depths below 1 m, those of dry land too, count as 1 m.
[[nodiscard]] double courant_length(double depth, double dt, double bound, double speed);
/// The operands are those of courant_length, in its order.
[[nodiscard]] Interval courant_length_over(const Interval* operands);
[[nodiscard]] Interval courant_length_slope(const Interval* operands, const Interval* slopes);

}  // namespace driftmesh
