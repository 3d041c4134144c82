#include "driftmesh/decomposition.hpp"

#include <memory>
#include <utility>
#include <vector>

#include "api/call.hpp"
#include "api/library_request.hpp"
#include "decompose/decomposition_file.hpp"
#include "driftmesh/repair.hpp"
#include "job/make.hpp"

namespace driftmesh {
namespace {

Pslg repaired(Pslg input) {
  static_cast<void>(repair(input));
  return input;
}

}  // namespace

std::shared_ptr<const Decomposition> cut_domain(const Pslg& input, const MeshOptions& options, std::int32_t ranks) {
  return in_words_of_library([&] {
    Call call(input, options);
    const job::Asked asked = call.asked(ranks > 1 ? job::kRanks : job::kSubdomains);
    return std::make_shared<const Decomposition>(job::make_cut(asked, ranks, call.watch()).decomposition);
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
