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

# Writes each block of C++ of a page to a file of its own in a folder: PAGE_1.inc and so on. There must be so many.
function(take_examples page expected folder)
  file(READ ${page} rest)
  cmake_path(GET page STEM name)
  set(count 0)
  string(FIND "${rest}" "\n```cpp\n" begin)
  while(NOT begin EQUAL -1)
    math(EXPR count "${count} + 1")
    math(EXPR begin "${begin} + 8")
    string(SUBSTRING "${rest}" ${begin} -1 rest)
    string(FIND "${rest}" "\n```" end)
    string(SUBSTRING "${rest}" 0 ${end} example)
    file(WRITE ${folder}/${name}_${count}.inc "${example}\n")
    string(FIND "${rest}" "\n```cpp\n" begin)
  endwhile()
  if(NOT count EQUAL expected)
    message(FATAL_ERROR "${page} has ${count} blocks of C++; ${expected} are built here")
  endif()
endfunction()
