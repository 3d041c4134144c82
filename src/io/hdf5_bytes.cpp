#include "io/hdf5_bytes.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <utility>

#include "base/read_file.hpp"
#include "base/write_at.hpp"
#include "driftmesh/error.hpp"
#include "hdf5/hdf5_handle.hpp"
#include "hdf5/own_content.hpp"
#include "io/read_checks.hpp"

namespace driftmesh {
namespace {

constexpr const char* kVersion = "version";

void check(bool done, const std::string& path) {
  if (!done) throw FileError(path, "cannot write");
}

Hdf5Handle space_of(std::uint64_t size) {
  const hsize_t extent = size;
  return {H5Screate_simple(1, &extent, nullptr), H5Sclose};
}

}  // namespace

Hdf5Places create_hdf5_bytes(const std::string& file, const std::string& path, std::int64_t version,
                             const std::map<std::string, std::uint64_t>& sizes) {
  const QuietHdf5 quiet;
  const Hdf5Handle made(H5Fcreate(file.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose);
  check(made.is_open(), path);
  const Hdf5Handle one(space_of(1));
  const Hdf5Handle number(H5Acreate(made.id(), kVersion, hdf5_type<std::int64_t>(), one.id(), H5P_DEFAULT, H5P_DEFAULT),
                          H5Aclose);
  check(H5Awrite(number.id(), H5T_NATIVE_INT64, &version) >= 0, path);
  const Hdf5Handle how(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_alloc_time(how.id(), H5D_ALLOC_TIME_EARLY);
  H5Pset_fill_time(how.id(), H5D_FILL_TIME_NEVER);
  Hdf5Places places;
  for (const auto& [name, size] : sizes) {
    const Hdf5Handle bytes(space_of(size));
    const Hdf5Handle set(
        H5Dcreate(made.id(), name.c_str(), hdf5_type<std::uint8_t>(), bytes.id(), H5P_DEFAULT, how.id(), H5P_DEFAULT),
        H5Dclose);
    check(set.is_open(), path);
    if (const haddr_t place = H5Dget_offset(set.id()); place != HADDR_UNDEF) places[name] = place;
  }
  check(H5Fflush(made.id(), H5F_SCOPE_GLOBAL) >= 0, path);
  return places;
}

void write_hdf5_bytes(const std::string& file, const std::string& path, std::uint64_t place,
                      std::span<const std::byte> bytes) {
  const int open = ::open(file.c_str(), O_WRONLY | O_CLOEXEC);
  if (open < 0) throw FileError(path, "cannot write");
  try {
    write_at(open, place, bytes, path);
  } catch (...) {
    ::close(open);
    throw;
  }
  check(::close(open) == 0, path);
}

Hdf5Bytes::Hdf5Bytes(const std::string& path) : path_(path) {
  require_regular_file(path);
  require_own_content(path);
  const QuietHdf5 quiet;
  const Hdf5Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  if (!file.is_open()) throw InputError({path, 0}, "is not an HDF5 file, or is damaged", "was it written completely?");
  const Hdf5Handle number(H5Aexists(file.id(), kVersion) > 0 ? H5Aopen(file.id(), kVersion, H5P_DEFAULT) : hid_t{-1},
                          H5Aclose);
  is_mesh_ = !number.is_open() && H5Lexists(file.id(), "geometry", H5P_DEFAULT) > 0 &&
             H5Lexists(file.id(), "viz", H5P_DEFAULT) > 0;
  if (is_mesh_) return;
  const Hdf5Handle extent(number.is_open() ? H5Aget_space(number.id()) : hid_t{-1}, H5Sclose);
  if (!number.is_open() || H5Sget_simple_extent_npoints(extent.id()) != 1 ||
      H5Aread(number.id(), H5T_NATIVE_INT64, &version_) < 0)
    throw InputError({path, 0}, "has no version of its content", "was it written by driftmesh?");
  const std::uint64_t bytes = std::filesystem::file_size(path);
  H5G_info_t group{};
  H5Gget_info(file.id(), &group);
  for (hsize_t i = 0; i < group.nlinks; ++i) {
    std::string name(256, '\0');
    const ssize_t length =
        H5Lget_name_by_idx(file.id(), ".", H5_INDEX_NAME, H5_ITER_NATIVE, i, name.data(), name.size(), H5P_DEFAULT);
    if (length <= 0) continue;
    name.resize(std::min<std::size_t>(static_cast<std::size_t>(length), name.size() - 1));
    const Hdf5Handle set(H5Dopen(file.id(), name.c_str(), H5P_DEFAULT), H5Dclose);
    if (!set.is_open()) continue;
    const Hdf5Handle type(H5Dget_type(set.id()), H5Tclose);
    const Hdf5Handle space(H5Dget_space(set.id()), H5Sclose);
    const hssize_t size = H5Sget_simple_extent_npoints(space.id());
    if (size < 0 || H5Tget_size(type.id()) != 1) continue;
    const haddr_t place = H5Dget_offset(set.id());
    if (size > 0 && (place == HADDR_UNDEF || place > bytes || static_cast<std::uint64_t>(size) > bytes - place))
      throw InputError({path, 0}, "ends before the array " + name + " does", kDamaged);
    arrays_[name] = {place, static_cast<std::uint64_t>(size)};
  }
}

const Hdf5Bytes::Array& Hdf5Bytes::array(const std::string& name) const {
  const auto found = arrays_.find(name);
  if (found == arrays_.end()) throw InputError({path_, 0}, "has no array " + name, "was it written by driftmesh?");
  return found->second;
}

std::uint64_t Hdf5Bytes::size_of(const std::string& name) const {
  return array(name).size;
}

Bytes Hdf5Bytes::read(const std::string& name, std::uint64_t first, std::uint64_t count) const {
  const Array& from = array(name);
  if (first > from.size || count > from.size - first)
    throw InputError({path_, 0}, "ends before the array " + name + " does", kDamaged);
  Bytes bytes(count);
  std::ifstream file(path_, std::ios::binary);
  file.seekg(static_cast<std::streamoff>(from.place + first));
  file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(count));
  if (!file) throw FileError(path_, "cannot read");
  return bytes;
}

}  // namespace driftmesh
