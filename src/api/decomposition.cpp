#include "driftmesh/decomposition.hpp"

#include <memory>
#include <utility>
#include <vector>

#include "api/call.hpp"
#include "api/library_request.hpp"
#include "decompose/decomposition_file.hpp"
#include "driftmesh/repair.hpp"
#include "job/prepare.hpp"
#include "job/triangulated.hpp"

namespace driftmesh {
namespace {

Pslg repaired(Pslg input) {
  static_cast<void>(repair(input));
  return input;
}

}  // namespace

std::shared_ptr<const Decomposition> cut_domain(const Pslg& input, const MeshOptions& options, std::int32_t ranks) {
  return with_words_of_options([&] {
    Call call(input, options);
    call.check(ranks > 1 ? job::kRanks : job::kSubdomains);
    const job::Domain domain = job::read_domain(call.request(), call.given(), call.watch());
    const job::Triangulated triangulated =
        job::triangulate_domain(call.request(), domain, ranks, job::Cut::kAlways, call.watch());
    return std::make_shared<const Decomposition>(job::cut(call.request(), triangulated, ranks));
  });
}

std::int32_t subdomains_of(const Decomposition& decomposition) {
  return static_cast<std::int32_t>(decomposition.size());
}

std::shared_ptr<const Decomposition> load_decomposition(const std::string& path, const Pslg& input) {
  return std::make_shared<const Decomposition>(read_decomposition(path, repaired(input)));
}

void save_decomposition(const Decomposition& decomposition, const Pslg& input, const std::string& path) {
  write_decomposition(decomposition, repaired(input), path);
}

}  // namespace driftmesh
