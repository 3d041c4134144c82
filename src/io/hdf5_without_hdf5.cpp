#include "base/built_without.hpp"
#include "io/hdf5_format.hpp"

namespace driftmesh {
namespace {

[[noreturn]] void refuse_hdf5(const std::string& path) {
  throw built_without("HDF5", "HDF5", path, "choose another format");
}

}  // namespace

Hdf5Places create_hdf5(const std::string& /*file*/, const std::string& path, const Hdf5Shape& /*shape*/) {
  refuse_hdf5(path);
}

void write_hdf5_part(const std::string& /*file*/, const std::string& path, const Hdf5Shape& /*shape*/,
                     const Hdf5Places& /*places*/, const Hdf5Part& /*part*/) {
  refuse_hdf5(path);
}

void write_hdf5(const Mesh& /*mesh*/, const std::string& path) {
  refuse_hdf5(path);
}

Mesh read_hdf5(const std::string& path) {
  refuse_hdf5(path);
}

}  // namespace driftmesh
