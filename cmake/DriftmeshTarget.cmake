# Flags that every target of the project shares, and the function that declares one box of the architecture.

add_library(driftmesh_flags INTERFACE)
# Contracting a*b+c into one fused operation changes the rounding that the exact predicates reason about and
# lets two nodes compute different shared points. It is off on every target, whatever the compiler's default.
if(CMAKE_CXX_COMPILER_ID STREQUAL "MSVC")
  target_compile_options(driftmesh_flags INTERFACE /fp:precise /W4)
elseif(CMAKE_CXX_COMPILER_FRONTEND_VARIANT STREQUAL "MSVC")  # clang-cl, which ignores options that it does not know
  target_compile_options(driftmesh_flags INTERFACE /clang:-ffp-contract=off /W4)
else()
  target_compile_options(driftmesh_flags INTERFACE -ffp-contract=off -Wall -Wextra -Wpedantic -Wshadow
                                                   -Wnon-virtual-dtor -Wold-style-cast)
endif()
target_include_directories(driftmesh_flags INTERFACE ${PROJECT_SOURCE_DIR}/include ${PROJECT_SOURCE_DIR}/src ${PROJECT_SOURCE_DIR})
if(DRIFTMESH_PORTABLE)
  target_compile_definitions(driftmesh_flags INTERFACE DRIFTMESH_PORTABLE)
endif()
if(DRIFTMESH_WERROR)
  target_compile_options(driftmesh_flags INTERFACE -Werror)
endif()
if(DRIFTMESH_CHECKED)
  target_compile_definitions(driftmesh_flags INTERFACE DRIFTMESH_CHECKED)
endif()
if(DRIFTMESH_SANITIZE)
  # Three checks of undefined behavior are left out, which took a quarter of the time to compile: the address sanitizer sees
  # what they look for, except for misaligned access, and bytes become numbers in one place only (src/base/bytes.hpp), by copying.
  # References to what has left its scope are looked for by -DDRIFTMESH_SANITIZE_SCOPES=ON alone: they take a third of that time.
  target_compile_options(driftmesh_flags INTERFACE -fsanitize=${DRIFTMESH_SANITIZE} -fno-sanitize=null,alignment,object-size
                                                   $<$<NOT:$<BOOL:${DRIFTMESH_SANITIZE_SCOPES}>>:-fno-sanitize-address-use-after-scope>
                                                   -fno-sanitize-recover=all -fno-omit-frame-pointer)
  target_link_options(driftmesh_flags INTERFACE -fsanitize=${DRIFTMESH_SANITIZE})
  # What the sanitizer knows of each variable has its address in it: to move a program takes half of the time that it takes to start.
  target_link_options(driftmesh_flags INTERFACE $<$<STREQUAL:$<TARGET_PROPERTY:TYPE>,EXECUTABLE>:-no-pie>)
endif()
if(DRIFTMESH_FUZZ)
  target_compile_options(driftmesh_flags INTERFACE -fsanitize=fuzzer-no-link)
endif()

# driftmesh_compile_together(TARGET): with DRIFTMESH_UNITY its sources are compiled together, 32 at a time: nothing that a file
# defines for itself may have the name of such a thing in another file. Files that need the same name nevertheless are kept out
# by the property SKIP_UNITY_BUILD_INCLUSION.
function(driftmesh_compile_together TARGET)
  if(DRIFTMESH_UNITY)
    set_target_properties(${TARGET} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 32)
  endif()
endfunction()

# driftmesh_library(NAME [COLD] SOURCES a.cpp ... [NEED lib b.cpp ... ELSE c.cpp ...] DEPENDS other boxes LIBS outside libraries)
# One box, which is the folder that this is called in. It includes headers of each box that DEPENDS names, and of no other;
# LIBS names the outside libraries (see OutsideLibraries.cmake) whose headers it includes or gets from another box's header.
# Sources that NEED a library are compiled where the build has it, those of ELSE where it does not: they refuse what takes it.
# COLD is for boxes in which no run spends time worth saving: they are compiled with fewer optimizations, in three quarters of the time.
# tests/structure/check_includes.py holds the sources to these declarations.
function(driftmesh_library NAME)
  cmake_parse_arguments(ARG "COLD" "" "SOURCES;NEED;ELSE;DEPENDS;LIBS" ${ARGN})
  if(ARG_NEED)
    list(POP_FRONT ARG_NEED needed)
    if(driftmesh_has_${needed})
      list(APPEND ARG_SOURCES ${ARG_NEED})
    else()
      list(APPEND ARG_SOURCES ${ARG_ELSE})
    endif()
  endif()
  if(ARG_SOURCES)
    add_library(dm_${NAME} STATIC ${ARG_SOURCES})
    if(DRIFTMESH_PYTHON)  # the module is a shared library, whose functions call each other directly all the same
      set_target_properties(dm_${NAME} PROPERTIES POSITION_INDEPENDENT_CODE ON)
      target_compile_options(dm_${NAME} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-fno-semantic-interposition>)
    endif()
    if(ARG_COLD)
      target_compile_options(dm_${NAME} PRIVATE $<$<CONFIG:Release>:-O1>)
    endif()
    driftmesh_compile_together(dm_${NAME})
    set(scope PUBLIC)
    set(own PRIVATE)
  else()
    add_library(dm_${NAME} INTERFACE)
    set(scope INTERFACE)
    set(own INTERFACE)
  endif()
  target_link_libraries(dm_${NAME} ${scope} driftmesh_flags)
  foreach(dep IN LISTS ARG_DEPENDS)
    target_link_libraries(dm_${NAME} ${scope} dm_${dep})
  endforeach()
  foreach(lib IN LISTS ARG_LIBS)
    target_link_libraries(dm_${NAME} ${own} ${driftmesh_lib_${lib}})
  endforeach()
  # For the library files that boxes are assembled to (see Product.cmake).
  set_property(GLOBAL PROPERTY driftmesh_depends_${NAME} ${ARG_DEPENDS})
  foreach(lib IN LISTS ARG_LIBS)
    set_property(GLOBAL APPEND PROPERTY driftmesh_libs_${NAME} ${driftmesh_lib_${lib}})
  endforeach()
endfunction()
