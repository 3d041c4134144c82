#include "hdf5/own_content.hpp"

#include "driftmesh/error.hpp"
#include "hdf5/hdf5_handle.hpp"

namespace driftmesh {
namespace {

constexpr const char* kNext = "make a file that holds everything: h5repack, or h5copy from where it leads to";

/// Whether the values of a dataset are elsewhere.
bool is_elsewhere(hid_t dataset) {
  const Hdf5Handle creation(H5Dget_create_plist(dataset), H5Pclose);
  return H5Pget_external_count(creation.id()) > 0 || H5Pget_layout(creation.id()) == H5D_VIRTUAL;
}

/// Visits a link; stops at one that leads elsewhere, and stores its name in the std::string `found`.
herr_t visit(hid_t group, const char* name, const H5L_info_t* link, void* found) {
  bool leads_elsewhere = link->type != H5L_TYPE_HARD && link->type != H5L_TYPE_SOFT;
  if (link->type == H5L_TYPE_HARD) {
    const Hdf5Handle object(H5Oopen(group, name, H5P_DEFAULT), H5Oclose);
    leads_elsewhere = H5Iget_type(object.id()) == H5I_DATASET && is_elsewhere(object.id());
  }
  if (leads_elsewhere) *static_cast<std::string*>(found) = name;
  return leads_elsewhere ? 1 : 0;
}

}  // namespace

void require_own_content(const std::string& path) {
  const QuietHdf5 quiet;
  if (H5Fis_hdf5(path.c_str()) <= 0) return;
  const Hdf5Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  std::string found;
  const herr_t end = file.is_open() ? H5Lvisit(file.id(), H5_INDEX_NAME, H5_ITER_NATIVE, visit, &found) : -1;
  if (end < 0) throw InputError({path, 0}, "is not an HDF5 file, or is damaged", "was it written completely?");
  if (end > 0) throw InputError({path, 0}, "takes its /" + found + " from another file", kNext);
}

}  // namespace driftmesh
