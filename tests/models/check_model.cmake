# cmake -DSPIN=spin -DCOMPILER=cc -DMODEL=m.pml -DFOLDER=work -DDEFINES="-DWORK=2 ..." -DPROPERTY=assertions|formula
#       -DEXPECT=holds|fails -P check_model.cmake
# Lets spin look at every state of the model: either no assertion (or the model's formula, under weak fairness) is ever
# violated, or, for a model broken on purpose, a violation is found.
function(run)
  execute_process(COMMAND ${ARGN} WORKING_DIRECTORY ${FOLDER} RESULT_VARIABLE code OUTPUT_VARIABLE output
                  ERROR_VARIABLE output)
  set(output "${output}" PARENT_SCOPE)
  if(NOT code EQUAL 0)
    message(FATAL_ERROR "${ARGN}: exit ${code}\n${output}")
  endif()
endfunction()

file(REMOVE_RECURSE ${FOLDER})
file(MAKE_DIRECTORY ${FOLDER})
separate_arguments(defines UNIX_COMMAND "${DEFINES}")
run(${SPIN} ${defines} -a ${MODEL})
run(${COMPILER} -x c -O1 -w -DNFAIR=6 -o pan pan.c)
if(PROPERTY STREQUAL "formula")
  run(./pan -m100000 -a -f)
else()
  run(./pan -m100000 -noclaim)  # which a model without a formula ignores
endif()

if(output MATCHES "max search depth too small" OR NOT output MATCHES "errors: ([0-9]+)[^0-9].* ([0-9]+) states, stored")
  message(FATAL_ERROR "spin did not search the whole model:\n${output}")
endif()
message(STATUS "${DEFINES}: ${CMAKE_MATCH_1} violations of the ${PROPERTY} in ${CMAKE_MATCH_2} states")
if((EXPECT STREQUAL "holds") AND (CMAKE_MATCH_1 GREATER 0))
  message(FATAL_ERROR "violated:\n${output}")
elseif((EXPECT STREQUAL "fails") AND (CMAKE_MATCH_1 EQUAL 0))
  message(FATAL_ERROR "a model broken on purpose passes")
endif()
