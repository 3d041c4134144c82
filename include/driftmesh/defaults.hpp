#pragma once

#include <cstdint>

/// Defaults of settings that several parts of the library have: the only place where they are written.
///
/// \code
/// driftmesh::MeshOptions options;
/// assert(options.min_angle == driftmesh::defaults::kMinAngle);
/// options.subdomains.slice = driftmesh::defaults::kSlice / 4;  // looks at messages more often
/// \endcode
namespace driftmesh::defaults {

inline constexpr double kMinAngle = 20;                ///< smallest angle of triangles, in degrees
inline constexpr std::int64_t kSizeResolution = 2000;  ///< squares along the longer side of the domain
inline constexpr double kSeparatorAngle = 60;          ///< smallest angle at separators, in degrees
inline constexpr double kCourant = 0.5;                ///< largest Courant number, if a time step is given
inline constexpr std::int64_t kSlice = 16384;          ///< points inserted between polls of the network
inline constexpr std::int64_t kAggregation = 512;      ///< split points in one message

inline constexpr double kLook = 0.01;   ///< seconds between a rank's checks of its own load
inline constexpr double kGap = 0.02;    ///< shortest time in seconds between reports of a rank, and between plans
inline constexpr double kInterval = 1;  ///< longest time in seconds between reports of a rank that has work
inline constexpr double kGain = 0.02;   ///< fraction of the finishing time that moving must save

inline constexpr double kLatency = 50e-6;         ///< seconds from the end of sending to arrival
inline constexpr double kBandwidth = 1e9;         ///< bytes per second
inline constexpr double kMessageOverhead = 1e-6;  ///< seconds for each message sent or received

}  // namespace driftmesh::defaults
