# HDF5 without MPI, as the imported target HDF5Serial::hdf5. By hand, because CMake's own module compiles C programs to find
# it, and Debian has it beside the one with MPI.
include(FindPackageHandleStandardArgs)
find_path(HDF5Serial_INCLUDE_DIR hdf5.h PATH_SUFFIXES hdf5/serial)
find_library(HDF5Serial_LIBRARY NAMES hdf5_serial hdf5)
mark_as_advanced(HDF5Serial_INCLUDE_DIR HDF5Serial_LIBRARY)
if(HDF5Serial_INCLUDE_DIR)
  file(STRINGS ${HDF5Serial_INCLUDE_DIR}/H5public.h number REGEX "#define +H5_VERS_INFO ")
  string(REGEX MATCH "[0-9]+[.][0-9]+[.][0-9]+" HDF5Serial_VERSION "${number}")
endif()
find_package_handle_standard_args(HDF5Serial REQUIRED_VARS HDF5Serial_LIBRARY HDF5Serial_INCLUDE_DIR
                                  VERSION_VAR HDF5Serial_VERSION)
if(HDF5Serial_FOUND AND NOT TARGET HDF5Serial::hdf5)
  add_library(HDF5Serial::hdf5 UNKNOWN IMPORTED)
  set_target_properties(HDF5Serial::hdf5 PROPERTIES IMPORTED_LOCATION "${HDF5Serial_LIBRARY}"
                                                    INTERFACE_INCLUDE_DIRECTORIES "${HDF5Serial_INCLUDE_DIR}")
  if(HDF5Serial_LIBRARY MATCHES "[.]a$")  # a static library does not say what it needs
    find_package(ZLIB REQUIRED)
    set_property(TARGET HDF5Serial::hdf5 PROPERTY INTERFACE_LINK_LIBRARIES ZLIB::ZLIB ${CMAKE_DL_LIBS} m)
  endif()
endif()
