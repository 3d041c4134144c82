// Text for every reader of Triangle's formats; if it is a valid .poly, it is repaired, and repaired again.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "driftmesh/error.hpp"
#include "driftmesh/repair.hpp"
#include "pslg/open_boundary.hpp"
#include "pslg/poly_file.hpp"
#include "pslg/triangle_files.hpp"

namespace {

using namespace driftmesh;

// In this folder no .node file is found.
constexpr const char* kFile = "/no-such-folder/fuzz.poly";

void require(bool condition) {
  if (!condition) std::abort();
}

void read_tables(std::string_view text) {
  try {
    const NodeTable nodes = parse_node(kFile, text);
    require(nodes.markers.empty() || nodes.markers.size() == nodes.points.size());
  } catch (const Error&) {
  }
  try {
    NodeTable nodes;
    nodes.points.resize(10);
    for (const auto& triangle : parse_ele(kFile, text, nodes).triangles)
      for (const std::int32_t corner : triangle) require(corner >= 0 && corner < 10);
  } catch (const Error&) {
  }
  try {
    require(parse_area(kFile, text, 3).size() == 3);
  } catch (const Error&) {
  }
}

void read_and_repair(std::string_view text) {
  try {
    Pslg pslg = parse_poly(kFile, text);
    const RepairReport report = repair(pslg, kFile);
    require(report.original_point.size() == pslg.points.size());
    require(!describe_open_boundary(pslg).empty());
    require(!repair(pslg, kFile).changed());
  } catch (const Error&) {
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  read_tables(text);
  read_and_repair(text);
  return 0;
}
