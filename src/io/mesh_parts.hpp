#pragma once

#include <cstdint>
#include <string>

#include "driftmesh/mesh.hpp"

namespace driftmesh {

/// What a mesh can have beyond points, triangles, and segments that bound it, as a set of bits.
using MeshParts = std::uint32_t;

inline constexpr MeshParts kPointMarkers = 1U << 0;
inline constexpr MeshParts kFirstAttribute = 1U << 1;   ///< the first value of each point
inline constexpr MeshParts kOtherAttributes = 1U << 2;  ///< all values of points but the first
inline constexpr MeshParts kMarkers = 1U << 3;          ///< markers of the segments that bound the domain
inline constexpr MeshParts kInnerSegments = 1U << 4;    ///< segments inside of the domain, with their markers
inline constexpr MeshParts kOrderOfSegments = 1U << 5;
inline constexpr MeshParts kRegions = 1U << 6;
inline constexpr MeshParts kMarkerNames = 1U << 7;
inline constexpr MeshParts kRegionNames = 1U << 8;
inline constexpr MeshParts kBoundaryTypes = 1U << 9;  ///< open sea and the types of ADCIRC (boundary_types.hpp)
inline constexpr MeshParts kWeirs = 1U << 10;         ///< heights and coefficients of weirs
inline constexpr MeshParts kSubdomains = 1U << 11;    ///< the subdomain and the rank of each triangle
inline constexpr MeshParts kAllParts = (1U << 12) - 1;

/// What every domain can have.
inline constexpr MeshParts kDomainParts =
    kPointMarkers | kFirstAttribute | kOtherAttributes | kMarkers | kInnerSegments | kOrderOfSegments | kRegions;
inline constexpr MeshParts kNamedParts = kMarkerNames | kRegionNames | kBoundaryTypes;

/// What the mesh has of the parts that are not in `kept`, in words for a warning: "regions; 9 segments inside of the
/// domain". Without those parts that follow from others, or are of the run that made the mesh.
[[nodiscard]] std::string lost_parts(const Mesh& mesh, MeshParts kept);

}  // namespace driftmesh
