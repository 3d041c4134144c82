# What `cmake --install` puts where, in components: the program, what programs that link the library need,
# and the Python package (python/CMakeLists.txt). No
# installed file holds a path of this machine: the prefix can be moved.
include(CMakePackageConfigHelpers)

set(DRIFTMESH_CMAKE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/driftmesh)

# ---- The program ----
if(DRIFTMESH_MPI)
  install(TARGETS driftmesh RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT program)
  install(DIRECTORY ${PROJECT_BINARY_DIR}/share/ DESTINATION ${CMAKE_INSTALL_DATADIR} COMPONENT program)  # manual, completion
  install(DIRECTORY configs DESTINATION ${CMAKE_INSTALL_DATADIR}/driftmesh COMPONENT program)
  install(FILES README.md CHANGELOG.md LICENSE CITATION.cff DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)
  install(DIRECTORY docs/ DESTINATION ${CMAKE_INSTALL_DOCDIR}/docs COMPONENT program)
endif()

# ---- The library ----
install(DIRECTORY include/driftmesh DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development
        FILES_MATCHING PATTERN "*.hpp" PATTERN "*.h")
foreach(name IN LISTS driftmesh_products)
  install(TARGETS driftmesh_${name}_product EXPORT driftmesh-${name}
          LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development
          ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development)
  install(EXPORT driftmesh-${name} NAMESPACE driftmesh:: FILE driftmesh-${name}.cmake
          DESTINATION ${DRIFTMESH_CMAKE_DIR} COMPONENT development)
endforeach()
if(TARGET driftmesh_triangle)
  install(TARGETS driftmesh_triangle EXPORT driftmesh-triangle LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development)
  install(EXPORT driftmesh-triangle NAMESPACE driftmesh:: FILE driftmesh-triangle.cmake
          DESTINATION ${DRIFTMESH_CMAKE_DIR} COMPONENT development)
endif()

configure_package_config_file(cmake/driftmeshConfig.cmake.in driftmeshConfig.cmake
                              INSTALL_DESTINATION ${DRIFTMESH_CMAKE_DIR} NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file(driftmeshConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/driftmeshConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/driftmeshConfigVersion.cmake
              cmake/FindHDF5Serial.cmake cmake/FindMETIS.cmake cmake/FindZoltan.cmake
        DESTINATION ${DRIFTMESH_CMAKE_DIR} COMPONENT development)

# A shared library finds by itself what it needs; who links the static one has to name it.
set(pc_needs)
foreach(need IN ITEMS BOOST_SERIALIZATION:boost_serialization HDF5:hdf5_serial METIS:metis ZLIB:z)
  string(REPLACE ":" ";" need ${need})
  list(GET need 0 part)
  list(GET need 1 library)
  if(DRIFTMESH_${part})
    string(APPEND pc_needs " -l${library}")
  endif()
endforeach()
set(pc_distributed_needs "-ltrilinos_zoltan")
if(BUILD_SHARED_LIBS)
  set(pc_needs)
  set(pc_distributed_needs)
endif()
file(RELATIVE_PATH pc_to_prefix "/${CMAKE_INSTALL_LIBDIR}/pkgconfig" "/")
set(pc_files driftmesh.pc)
if(DRIFTMESH_MPI)
  list(APPEND pc_files driftmesh-distributed.pc)
endif()
foreach(file IN LISTS pc_files)
  configure_file(cmake/${file}.in ${file} @ONLY)
  install(FILES ${CMAKE_CURRENT_BINARY_DIR}/${file} DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT development)
endforeach()

# ---- Packages: cpack -G DEB --config CPackConfig.cmake, in the build folder ----
set(CPACK_PACKAGE_NAME driftmesh)
set(CPACK_PACKAGE_VENDOR "the driftmesh authors")
set(CPACK_PACKAGE_CONTACT "The driftmesh authors <driftmesh@example.org>" CACHE STRING "Maintainer of packages")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_COMPONENTS_ALL development)
if(DRIFTMESH_MPI)
  list(PREPEND CPACK_COMPONENTS_ALL program)
endif()
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME driftmesh)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS openmpi-bin)
if(DRIFTMESH_HAS_GDAL)  # is loaded only when a file needs it
  string(REPLACE ".so." "" gdal_package "${gdal_soname}")
  set(CPACK_DEBIAN_PROGRAM_PACKAGE_SUGGESTS ${gdal_package})
  set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SUGGESTS ${gdal_package})
endif()
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION "Makes, checks, converts and draws triangle meshes.
 Quality bounds on angles and areas, on one core or with mpirun on many ranks,
 between which subdomains move while they are refined.")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libdriftmesh-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
    "libboost-serialization-dev, libhdf5-dev, libmetis-dev, zlib1g-dev")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_RECOMMENDS "libcairo2-dev, libopenmpi-dev, libtrilinos-zoltan-dev")
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION "The library of driftmesh: headers, static libraries, CMake package.
 driftmesh::driftmesh makes meshes in one process, driftmesh::distributed on the
 ranks of an MPI communicator.")
if(DRIFTMESH_PYTHON)
  list(APPEND CPACK_COMPONENTS_ALL python)
  math(EXPR next "${Python_VERSION_MINOR} + 1")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-driftmesh)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS ON)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "python3 (>= 3.${Python_VERSION_MINOR}), python3 (<< 3.${next}), python3-numpy")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_RECOMMENDS python3-mpi4py)
  set(CPACK_COMPONENT_PYTHON_DESCRIPTION "Triangle meshes of planar domains in Python.
 Meshes as numpy arrays, made in this process or on the ranks of an mpi4py
 communicator, with quality bounds on angles and areas.")
endif()
include(CPack)
