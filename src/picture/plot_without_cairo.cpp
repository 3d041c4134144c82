#include "base/built_without.hpp"
#include "picture/plot.hpp"

namespace driftmesh {
namespace {

[[noreturn]] void refuse_picture(const std::string& path) {
  throw built_without("cairo", "CAIRO", path, "write the mesh as .vtu and open it in ParaView");
}

}  // namespace

void plot(const Mesh& /*mesh*/, const std::string& path, const PlotOptions& /*options*/) {
  refuse_picture(path);
}

void plot(const Pslg& /*input*/, const std::string& path, const PlotOptions& /*options*/) {
  refuse_picture(path);
}

}  // namespace driftmesh
