#include "balancer/policies/policy_library.hpp"

#include <dlfcn.h>

#include <cstring>

#include "driftmesh/error.hpp"
#include "driftmesh/policy_library.hpp"

namespace driftmesh::balancer {
namespace {

/// Without a slash in its name, the system would look for it in its own folders.
std::string with_folder(const std::string& file) {
  return file.find('/') == std::string::npos ? "./" + file : file;
}

const PolicyEntry& entry_of(const std::string& file) {
  void* const library = dlopen(with_folder(file).c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr)
    throw InputError({file, 0}, std::string("cannot be loaded as a policy: ") + dlerror(),
                     "build it as docs/write-a-policy.md describes");
  const auto* const entry = static_cast<const PolicyEntry*>(dlsym(library, "driftmesh_policy"));
  if (entry == nullptr)
    throw InputError({file, 0}, "is a shared library, but has no policy", "add DRIFTMESH_POLICY(name, function)");
  if (std::strcmp(entry->version, DRIFTMESH_VERSION) != 0)
    throw InputError({file, 0},
                     std::string("was built for driftmesh ") + entry->version + ", but this is " DRIFTMESH_VERSION,
                     "build it again with the headers of this version");
  return *entry;
}

}  // namespace

std::unique_ptr<Policy> make_policy_of_library(const std::string& file, const Parameters::Values& values) {
  const PolicyEntry& entry = entry_of(file);
  Parameters parameters(entry.name, values);
  auto policy = entry.make(parameters);
  if (policy == nullptr) throw InputError({file, 0}, "made no policy", "its function must return one");
  parameters.finish();
  return policy;
}

}  // namespace driftmesh::balancer
