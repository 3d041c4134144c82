# The libraries that are not ours: how each is found, and the short name by which a box declares that it uses it
# (LIBS in driftmesh_library). tests/structure/check_includes.py knows the headers that belong to each name.

# Whoever takes the project in with add_subdirectory links them too.
set(CMAKE_FIND_PACKAGE_TARGETS_GLOBAL ON)
list(APPEND CMAKE_MODULE_PATH ${PROJECT_SOURCE_DIR}/cmake)
set(MPI_CXX_SKIP_MPICXX ON)  # the C++ bindings that MPI 3 dropped
find_package(PkgConfig REQUIRED)
find_package(Boost REQUIRED COMPONENTS serialization)
find_package(CLI11 REQUIRED)
find_package(fmt REQUIRED)
find_package(HDF5Serial MODULE REQUIRED)
find_package(METIS MODULE REQUIRED)
find_package(MPI REQUIRED COMPONENTS CXX)
find_package(muparser REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(Threads REQUIRED)
find_package(ZLIB REQUIRED)
find_package(Zoltan MODULE REQUIRED)
pkg_check_modules(CAIRO REQUIRED IMPORTED_TARGET cairo)
pkg_check_modules(YAML_CPP REQUIRED IMPORTED_TARGET yaml-cpp)

if(DRIFTMESH_PYTHON)
  set(Python_ROOT_DIR /usr CACHE PATH "Where the Python is that the module is made for: the one with Debian's packages")
  set(PYBIND11_FINDPYTHON ON)
  find_package(pybind11 REQUIRED)
endif()

set(driftmesh_lib_boost_serialization Boost::serialization)
set(driftmesh_lib_cairo PkgConfig::CAIRO)
set(driftmesh_lib_cli11 CLI11::CLI11)
set(driftmesh_lib_fmt fmt::fmt)
set(driftmesh_lib_hdf5 HDF5Serial::hdf5)
set(driftmesh_lib_json $<BUILD_INTERFACE:nlohmann_json::nlohmann_json>)  # only headers: nobody who links us needs it
set(driftmesh_lib_metis METIS::metis)
set(driftmesh_lib_mpi MPI::MPI_CXX)
set(driftmesh_lib_muparser muparser::muparser)
set(driftmesh_lib_pybind11 pybind11::module)
set(driftmesh_lib_threads Threads::Threads)
set(driftmesh_lib_yaml PkgConfig::YAML_CPP)
set(driftmesh_lib_zlib ZLIB::ZLIB)
set(driftmesh_lib_zoltan Zoltan::zoltan)
