# Zoltan, as the imported target Zoltan::zoltan. By hand, because the CMake files that Debian packages with it name
# libraries that only its own build needs.
include(FindPackageHandleStandardArgs)
find_path(ZOLTAN_INCLUDE_DIR zoltan.h PATH_SUFFIXES trilinos)
find_library(ZOLTAN_LIBRARY NAMES trilinos_zoltan zoltan)
mark_as_advanced(ZOLTAN_INCLUDE_DIR ZOLTAN_LIBRARY)
if(ZOLTAN_INCLUDE_DIR)
  file(STRINGS ${ZOLTAN_INCLUDE_DIR}/zoltan.h number REGEX "#define ZOLTAN_VERSION_NUMBER")
  string(REGEX MATCH "[0-9.]+" Zoltan_VERSION "${number}")
endif()
find_package_handle_standard_args(Zoltan REQUIRED_VARS ZOLTAN_LIBRARY ZOLTAN_INCLUDE_DIR VERSION_VAR Zoltan_VERSION)
if(Zoltan_FOUND AND NOT TARGET Zoltan::zoltan)
  add_library(Zoltan::zoltan UNKNOWN IMPORTED)
  set_target_properties(Zoltan::zoltan PROPERTIES IMPORTED_LOCATION "${ZOLTAN_LIBRARY}"
                                                  INTERFACE_INCLUDE_DIRECTORIES "${ZOLTAN_INCLUDE_DIR}")
endif()
