#include <doctest/doctest.h>

#include <cstddef>
#include <string>

#include "pslg/triangle_files.hpp"
#include "support/cut_mesh_size.hpp"
#include "support/made_mesh.hpp"

// Domains in which separators ran beside a wall. Their points lie within a millimeter or a nanometer of lines.

using namespace driftmesh;

TEST_CASE("points near the lines of their hull take few triangles more in subdomains") {
  struct Case {
    const char* name;
    std::size_t in_one_piece;
  };
  for (const auto& [name, in_one_piece] :
       {Case{"best3", 434}, Case{"best4", 179}, Case{"turned-grid-mm", 4856}, Case{"turned-grid-nm", 9534}}) {
    CAPTURE(name);
    Pslg pslg;
    pslg.points =
        read_node(std::string(DRIFTMESH_SOURCE_DIR) + "/tests/regression/input/slits/" + name + ".node").points;
    const job::Request request = testing::bounded(20);
    CHECK(testing::made(pslg, request).mesh.triangles.size() == in_one_piece);
    for (const int n : {2, 5, 16, 40, 60, 100}) {
      CAPTURE(n);
      const testing::CutMeshSize cut = testing::cut_mesh_size(pslg, request, n, 50000);
      CHECK(cut.complete);
      CHECK(static_cast<double>(cut.triangles) <=
            1.1 * static_cast<double>(in_one_piece) + 4 * static_cast<double>(cut.separator_edges));
    }
  }
}
