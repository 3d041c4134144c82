# The libraries that are not ours: how each is found, and the short name by which a box declares that it uses it
# (LIBS in driftmesh_library). tests/structure/check_includes.py knows the headers that belong to each name.

set(MPI_CXX_SKIP_MPICXX ON)  # the C++ bindings that MPI 3 dropped
find_package(PkgConfig REQUIRED)
find_package(Boost REQUIRED COMPONENTS serialization)
find_package(CLI11 REQUIRED)
find_package(fmt REQUIRED)
find_package(MPI REQUIRED COMPONENTS CXX)
find_package(nlohmann_json REQUIRED)
find_package(Threads REQUIRED)
pkg_check_modules(CAIRO REQUIRED IMPORTED_TARGET cairo)
pkg_check_modules(MUPARSER REQUIRED IMPORTED_TARGET muparser)
pkg_check_modules(YAML_CPP REQUIRED IMPORTED_TARGET yaml-cpp)

# Zoltan as Debian packages it: its CMake files name libraries that only its own build needs.
find_path(ZOLTAN_INCLUDE_DIR zoltan.h PATH_SUFFIXES trilinos REQUIRED)
find_library(ZOLTAN_LIBRARY NAMES trilinos_zoltan zoltan REQUIRED)
add_library(driftmesh_zoltan INTERFACE)
target_include_directories(driftmesh_zoltan SYSTEM INTERFACE ${ZOLTAN_INCLUDE_DIR})
target_link_libraries(driftmesh_zoltan INTERFACE ${ZOLTAN_LIBRARY})

set(driftmesh_lib_boost_serialization Boost::serialization)
set(driftmesh_lib_cairo PkgConfig::CAIRO)
set(driftmesh_lib_cli11 CLI11::CLI11)
set(driftmesh_lib_fmt fmt::fmt)
set(driftmesh_lib_json nlohmann_json::nlohmann_json)
set(driftmesh_lib_metis metis)
set(driftmesh_lib_mpi MPI::MPI_CXX)
set(driftmesh_lib_muparser PkgConfig::MUPARSER)
set(driftmesh_lib_threads Threads::Threads)
set(driftmesh_lib_yaml PkgConfig::YAML_CPP)
set(driftmesh_lib_zoltan driftmesh_zoltan)
