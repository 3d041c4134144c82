#pragma once

#include <string>

#include "driftmesh/error.hpp"

namespace driftmesh {

/// The error for a file that takes a library, such as HDF5, which this build was made without. `instead`: what can be
/// done with this build. The option DRIFTMESH_<part> of the build switches the library on.
[[nodiscard]] inline InputError built_without(const std::string& library, const char* part, const std::string& file,
                                              const std::string& instead) {
  return {{file, 0},
          "takes " + library + ", which this driftmesh was built without",
          instead + ", or build it with -DDRIFTMESH_" + part + "=ON"};
}

}  // namespace driftmesh
