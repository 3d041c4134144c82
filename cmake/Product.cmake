# What is built for others: library files, each assembled from boxes, and their names for those who link them.
#
#   driftmesh::driftmesh     meshes in this process; neither its headers nor its link line know of MPI
#   driftmesh::distributed   meshes on the ranks of a communicator or in simulation; brings driftmesh::driftmesh with it
#   driftmesh::pictures      pictures of inputs and meshes; brings driftmesh::driftmesh with it
#   driftmesh::triangle      the call of Triangle's C library: a shared library by itself

# The named boxes and all that they depend on.
function(driftmesh_closure OUT)
  set(open ${ARGN})
  set(all)
  while(open)
    list(POP_FRONT open box)
    if(NOT box IN_LIST all)
      list(APPEND all ${box})
      get_property(depends GLOBAL PROPERTY driftmesh_depends_${box})
      list(APPEND open ${depends})
    endif()
  endwhile()
  set(${OUT} ${all} PARENT_SCOPE)
endfunction()

# driftmesh_product(NAME FILE BOXES boxes LINKS targets): the target driftmesh::NAME, a library file lib<FILE> that holds
# these boxes. What they need of other people's libraries is linked, but its headers are not for the user. The boxes' own
# flags and include roots stay behind.
function(driftmesh_product NAME FILE)
  cmake_parse_arguments(ARG "" "" "BOXES;LINKS" ${ARGN})
  set(objects)
  set(libs)
  foreach(box IN LISTS ARG_BOXES)
    get_target_property(type dm_${box} TYPE)
    if(NOT type STREQUAL "INTERFACE_LIBRARY")
      list(APPEND objects $<TARGET_OBJECTS:dm_${box}>)
    endif()
    get_property(of_box GLOBAL PROPERTY driftmesh_libs_${box})
    list(APPEND libs ${of_box})
  endforeach()
  list(REMOVE_DUPLICATES libs)
  set(target driftmesh_${NAME}_product)
  add_library(${target} ${objects})
  add_library(driftmesh::${NAME} ALIAS ${target})
  target_link_libraries(${target} PRIVATE ${libs} PUBLIC ${ARG_LINKS})
  target_compile_features(${target} INTERFACE cxx_std_20)
  target_include_directories(${target} INTERFACE $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include>
                                                 $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  if(DRIFTMESH_SANITIZE)  # whoever links instrumented objects must be instrumented
    target_compile_options(${target} INTERFACE $<BUILD_INTERFACE:-fsanitize=${DRIFTMESH_SANITIZE}>)
    target_link_options(${target} INTERFACE $<BUILD_INTERFACE:-fsanitize=${DRIFTMESH_SANITIZE}>)
  endif()
  set_target_properties(${target} PROPERTIES
    LINKER_LANGUAGE CXX OUTPUT_NAME ${FILE} EXPORT_NAME ${NAME} VERSION ${PROJECT_VERSION}
    SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})  # before 1.0 a minor version may break callers
endfunction()

driftmesh_closure(boxes api)
driftmesh_product(driftmesh driftmesh BOXES ${boxes})
set(driftmesh_products driftmesh)
if(DRIFTMESH_MPI)
  driftmesh_closure(boxes_of_ranks api_mpi api_simulated)
  list(REMOVE_ITEM boxes_of_ranks ${boxes})
  driftmesh_product(distributed driftmesh_distributed BOXES ${boxes_of_ranks} LINKS driftmesh::driftmesh MPI::MPI_CXX)
  list(APPEND driftmesh_products distributed)
endif()
driftmesh_closure(boxes_of_pictures picture)
list(REMOVE_ITEM boxes_of_pictures ${boxes})
driftmesh_product(pictures driftmesh_pictures BOXES ${boxes_of_pictures} LINKS driftmesh::driftmesh)
list(APPEND driftmesh_products pictures)

# For C. Its names and structures are those of its own version, so it exports them and nothing else, whatever is in it. Only where
# boxes are compiled for shared libraries, and the linker knows versions.
if((DRIFTMESH_PYTHON OR BUILD_SHARED_LIBS) AND NOT APPLE AND NOT WIN32)
  set(exports ${PROJECT_SOURCE_DIR}/src/triangle/c/exports.map)
  add_library(driftmesh_triangle SHARED $<TARGET_OBJECTS:dm_triangle_c>)
  add_library(driftmesh::triangle ALIAS driftmesh_triangle)
  target_link_libraries(driftmesh_triangle PRIVATE dm_triangle)
  target_link_options(driftmesh_triangle PRIVATE LINKER:--exclude-libs,ALL LINKER:--version-script=${exports})
  target_include_directories(driftmesh_triangle INTERFACE $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include>
                                                          $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  set_target_properties(driftmesh_triangle PROPERTIES LINKER_LANGUAGE CXX EXPORT_NAME triangle VERSION 1.0 SOVERSION 1
                                                      LINK_DEPENDS ${exports})
endif()
