// The content of a packed subdomain after a valid header: rejected with an error that names the packed form, or a
// subdomain that packs to the same bytes and whose handles are valid.
#include <cstdint>
#include <cstdlib>
#include <span>
#include <string_view>

#include "decompose/decompose.hpp"
#include "driftmesh/error.hpp"
#include "mesh/cdt.hpp"
#include "mesh/digest.hpp"
#include "migration/packed_bytes.hpp"
#include "migration/subdomain.hpp"

using namespace driftmesh;

namespace {

/// A square cut in two.
Decomposition decomposition() {
  Pslg pslg;
  pslg.points = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  pslg.segments = {{0, 1, 1}, {1, 2, 2}, {2, 3, 3}, {3, 0, 4}};
  DecomposeOptions options;
  options.subdomains = 2;
  return decompose(triangulate(pslg), options);
}

Bytes sealed(const std::uint8_t* data, std::size_t size) {
  SealedBytes bytes(size);
  bytes.append(data, size);
  return bytes.take();
}

void walk(Subdomain& subdomain) {
  if (!subdomain.started()) return;
  subdomain.wake();
  const Triangulation& mesh = subdomain.mesh().mesh;
  if (mesh_digest(mesh) == 1) std::abort();
  for (const Subsegment& s : mesh.subsegments)
    if (!mesh.subsegments.has(mesh.descend(s.root, s.path))) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Decomposition cut = decomposition();
  static const SubdomainContext context{&cut, {}, false};
  const Bytes bytes = sealed(data, size);
  try {
    Subdomain subdomain = Subdomain::unpack(bytes, context);
    if (subdomain.pack() != bytes) std::abort();
    walk(subdomain);
  } catch (const Error& error) {
    if (!std::string_view(error.what()).starts_with("the packed form of subdomain ")) std::abort();
  }
  return 0;
}
