# HDF5 without MPI, as the imported target HDF5Serial::hdf5. By hand, because CMake's own module compiles C programs to find
# it, and Debian has it beside the one with MPI. HDF5Serial::for_programs is its archive, where that is there: Debian's shared
# library loads 28 others at each start, curl among them, in two fifths of the time of a short command.
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
if(HDF5Serial_FOUND AND NOT TARGET HDF5Serial::for_programs)
  add_library(HDF5Serial::for_programs INTERFACE IMPORTED)
  find_library(HDF5Serial_ARCHIVE NAMES libhdf5_serial.a)
  find_library(HDF5Serial_SZIP_ARCHIVE NAMES libsz.a)
  find_library(HDF5Serial_AEC_ARCHIVE NAMES libaec.a)
  mark_as_advanced(HDF5Serial_ARCHIVE HDF5Serial_SZIP_ARCHIVE HDF5Serial_AEC_ARCHIVE)
  if(HDF5Serial_ARCHIVE AND HDF5Serial_SZIP_ARCHIVE AND HDF5Serial_AEC_ARCHIVE)
    find_package(ZLIB REQUIRED)
    target_link_libraries(HDF5Serial::for_programs INTERFACE ${HDF5Serial_ARCHIVE} ${HDF5Serial_SZIP_ARCHIVE} ${HDF5Serial_AEC_ARCHIVE}
                                                             ZLIB::ZLIB ${CMAKE_DL_LIBS} m)
  else()
    target_link_libraries(HDF5Serial::for_programs INTERFACE HDF5Serial::hdf5)
  endif()
endif()
