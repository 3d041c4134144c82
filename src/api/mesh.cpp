#include <memory>
#include <string>
#include <utility>

#include "api/call.hpp"
#include "api/library_request.hpp"
#include "driftmesh/error.hpp"
#include "driftmesh/mesher.hpp"
#include "job/here.hpp"
#include "job/make.hpp"

namespace driftmesh {

Mesh mesh(const Pslg& input, const MeshOptions& options) {
  return in_words_of_library([&] {
    Call call(input, options);
    job::Here here(call.place(), call.threads());
    job::RunRecord record;
    const std::unique_ptr<job::Refined> made = job::make(call.asked(here.kind()), here, record, call.watch());
    if (const KeyText why = made->shortfall(true); !why.empty()) throw Keyed<LimitError>(why);
    call.require_step(here, *made, record);
    Mesh mesh = made->take_piece(call.watch()).mesh;
    mesh.numbers.clear();  // only for points of a piece; this is the whole mesh
    mesh.ranks.clear();
    return mesh;
  });
}

}  // namespace driftmesh
