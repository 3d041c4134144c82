# cmake -DMPIEXEC=... -DPROGRAM=... -P check_failing_rank.cmake
# Three ranks, of which one fails: mpiexec must end by itself, with a code other than 0, and the reason must be said once.
execute_process(COMMAND ${MPIEXEC} -n 3 --oversubscribe ${PROGRAM} RESULT_VARIABLE code ERROR_VARIABLE errors
                OUTPUT_VARIABLE output TIMEOUT 60)
set(reason "driftmesh: rank 1: subdomain 7: the size field is not above 0 at (1, 2)")
string(REPLACE "${reason}" "" without "${errors}")
string(LENGTH "${errors}" length)
string(LENGTH "${without}" length_without)
string(LENGTH "${reason}" length_reason)
math(EXPR times "(${length} - ${length_without}) / ${length_reason}")
if(code EQUAL 0 OR NOT code MATCHES "^[0-9]+$" OR NOT times EQUAL 1)
  message(FATAL_ERROR "exit '${code}', the reason is given ${times} times:\n${output}\n${errors}")
endif()
