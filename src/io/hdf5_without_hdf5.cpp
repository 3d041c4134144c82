#include "base/built_without.hpp"
#include "io/hdf5_bytes.hpp"
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

void write_hdf5(const Mesh& /*mesh*/, const TriangleData& /*data*/, const std::string& path) {
  refuse_hdf5(path);
}

Mesh read_hdf5(const std::string& path) {
  refuse_hdf5(path);
}

Mesh read_hdf5(const std::string& path, TriangleData& /*data*/) {
  refuse_hdf5(path);
}

Hdf5Places create_hdf5_bytes(const std::string& /*file*/, const std::string& path, std::int64_t /*version*/,
                             const std::map<std::string, std::uint64_t>& /*sizes*/) {
  refuse_hdf5(path);
}

void write_hdf5_bytes(const std::string& /*file*/, const std::string& path, std::uint64_t /*place*/,
                      std::span<const std::byte> /*bytes*/) {
  refuse_hdf5(path);
}

Hdf5Bytes::Hdf5Bytes(const std::string& path) {
  refuse_hdf5(path);
}

std::uint64_t Hdf5Bytes::size_of(const std::string& /*array*/) const {
  refuse_hdf5(path_);
}

Bytes Hdf5Bytes::read(const std::string& /*array*/, std::uint64_t /*first*/, std::uint64_t /*count*/) const {
  refuse_hdf5(path_);
}

}  // namespace driftmesh
