# steps.cmake - what the tests of the installed package share.

function(step)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
  message("${output}")
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "status ${status} from: ${ARGN}")
  endif()
endfunction()

# A project in the folder `source` is configured in the folder `build`, as a user of find_package(Tandem) would.
function(configure source build)
  step(${CMAKE_COMMAND} -S ${source} -B ${build} -G ${GENERATOR} -DCMAKE_CXX_COMPILER=${COMPILER}
    -DCMAKE_PREFIX_PATH=${SCRATCH}/prefix)
endfunction()

# What a program prints, if it ends with status 0.
function(run program result)
  execute_process(COMMAND ${program} RESULT_VARIABLE status OUTPUT_VARIABLE printed)
  message("${printed}")
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "${program} ends with status ${status}")
  endif()
  set(${result} "${printed}" PARENT_SCOPE)
endfunction()

function(must_show page what text)
  file(READ ${page} shown)
  string(FIND "${shown}" "${text}" found)
  if(found EQUAL -1)
    message(FATAL_ERROR "${page} does not show ${what}: ${text}")
  endif()
endfunction()
