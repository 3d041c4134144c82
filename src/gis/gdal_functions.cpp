#include "gis/gdal_functions.hpp"

#include <dlfcn.h>
#include <unistd.h>

#include <type_traits>

#include "driftmesh/error.hpp"

namespace driftmesh {

#ifdef DRIFTMESH_GDAL_LIBRARY

namespace {

struct Loaded {
  GdalFunctions functions{};
  std::string problem;  // empty: there is none
};

/// Is never closed: GDAL does not expect to be.
Loaded load() {
  Loaded loaded;
  void* const library = ::dlopen(DRIFTMESH_GDAL_LIBRARY, RTLD_NOW | RTLD_LOCAL);
  const auto find = [&](auto& function, const char* name) {
    void* const found = library != nullptr && loaded.problem.empty() ? ::dlsym(library, name) : nullptr;
    if (found == nullptr && loaded.problem.empty()) loaded.problem = ::dlerror();  // NOLINT(concurrency-mt-unsafe)
    function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(found);
  };
// NOLINTNEXTLINE(cppcoreguidelines-macro-usage)
#define DRIFTMESH_GDAL_FIND(name) find(loaded.functions.name, #name);
  DRIFTMESH_GDAL_FUNCTIONS(DRIFTMESH_GDAL_FIND)
#undef DRIFTMESH_GDAL_FIND
  if (loaded.problem.empty()) loaded.functions.GDALAllRegister();
  return loaded;
}

}  // namespace

const GdalFunctions& gdal_for(const std::string& file) {
  static const Loaded loaded = load();
  if (!loaded.problem.empty())
    throw InputError({file}, "takes GDAL to be read, which cannot be loaded (" + loaded.problem + ")",
                     "install Debian's package libgdal32, or convert the file to GeoJSON or .asc");
  return loaded.functions;
}

OwnedByUs<GDALDatasetH> open_by_gdal(const GdalFunctions& gdal, const std::string& file, unsigned kind) {
  const QuietGdal quiet(gdal);
  OwnedByUs<GDALDatasetH> data(gdal.GDALOpenEx(file.c_str(), kind | GDAL_OF_READONLY, nullptr, nullptr, nullptr),
                               [&gdal](GDALDatasetH opened) { gdal.GDALClose(opened); });
  if (data == nullptr && ::access(file.c_str(), R_OK) != 0) throw FileError(file, "cannot open");
  if (data == nullptr)
    throw InputError({file}, quiet.message("is of no format that GDAL knows"),
                     "ogrinfo and gdalinfo say what GDAL makes of it");
  return data;
}

QuietGdal::QuietGdal(const GdalFunctions& gdal) : gdal_(gdal) {
  gdal_.CPLPushErrorHandler(gdal_.CPLQuietErrorHandler);
  gdal_.CPLErrorReset();
}

QuietGdal::~QuietGdal() {
  gdal_.CPLPopErrorHandler();
}

std::string QuietGdal::message(const std::string& otherwise) const {
  const std::string found = gdal_.CPLGetLastErrorMsg();
  return found.empty() ? otherwise : found;
}

bool QuietGdal::failed() const {
  return gdal_.CPLGetLastErrorType() >= CE_Failure;
}

#else

void refuse_without_gdal(const std::string& file) {
  throw InputError({file}, "takes GDAL to be read, which this driftmesh was built without",
                   "install Debian's package libgdal-dev and build again, or convert the file to GeoJSON or .asc");
}

#endif

}  // namespace driftmesh
