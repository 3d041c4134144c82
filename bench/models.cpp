#include "bench/models.hpp"

#include <utility>

#include "bench/cgal_mesher.hpp"
#include "driftmesh/generate.hpp"
#include "pslg/poly_file.hpp"

namespace driftmesh::bench {
namespace {

Model with_area(const std::string& name, Pslg pslg) {
  const double area = domain_area(pslg);
  return {name, std::move(pslg), area};
}

}  // namespace

std::vector<Model> load_models(const std::filesystem::path& folder) {
  const auto load = [&](const std::string& name, const std::string& substitute, const auto& generate) {
    const std::filesystem::path path = folder / (name + ".poly");
    return std::filesystem::exists(path) ? with_area(name, read_poly(path.string()))
                                         : with_area(substitute, generate());
  };
  return {load("pipe", "generated pipe", [] { return generate_pipe({}); }),
          load("cylinder_flow", "generated cylinder flow", [] { return generate_cylinder_flow({}); }),
          load("chesapeake", "generated bay", [] { return generate_bay({}); }),
          with_area("rectangle with a hole", generate_rectangle_hole({}))};
}

}  // namespace driftmesh::bench
