# The tests of a sanitizer tree (presets asan and tsan): the Catch2 tests tagged [sanitizer], among them scenes large
# enough that kernels are split over several threads, and for addresses those tagged [address], too; whole files of
# tests of what reads files and of the command; and faults that must be seen. Drivers of OpenCL are not instrumented:
# left out.
set(launcher)
if(TANDEM_SANITIZE MATCHES thread)
  # The thread sanitizer of some compilers cannot place its shadow memory under strong address randomisation.
  execute_process(COMMAND setarch -R true RESULT_VARIABLE setarch_failed OUTPUT_QUIET ERROR_QUIET)
  if(NOT setarch_failed)
    set(launcher setarch -R)
  endif()
endif()

function(sanitizer_test name)
  tandem_test(NAME sanitizer.${name} LABEL sanitizer TIMEOUT 900
    ENVIRONMENT TANDEM_COMMAND=$<TARGET_FILE:tandem_command> OCL_ICD_VENDORS=/nonexistent
      OPENCL_VENDOR_PATH=/nonexistent TANDEM_TEST_SHARE_OF_FAULTS=31
    COMMAND ${launcher} ${ARGN})
  # which would ask for these drivers
  set_property(TEST sanitizer.${name} APPEND PROPERTY ENVIRONMENT_MODIFICATION CI=unset:)
endfunction()

set(tagged "[sanitizer]")
if(TANDEM_SANITIZE MATCHES address)
  string(APPEND tagged ",[address]")
endif()
sanitizer_test(unit $<TARGET_FILE:tandem_tests> ${fail_without_tests} ${tagged})

if(TARGET tandem_heap_tests)
  sanitizer_test(heap $<TARGET_FILE:tandem_heap_tests> ${fail_without_tests} "[sanitizer]")
  add_dependencies(tandem_tests tandem_heap_tests)
endif()

add_executable(tandem_planted sanitizers/planted.cpp)
target_include_directories(tandem_planted PRIVATE ${PROJECT_SOURCE_DIR})
target_link_libraries(tandem_planted PRIVATE tandem_io tandem)
set_target_properties(tandem_planted PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/build-tools)
add_dependencies(tandem_tests tandem_planted) # one target builds what the tests run

# sanitizer_sees(name regex arguments...): a report that matches, whatever the exit status.
function(sanitizer_sees name report)
  sanitizer_test(sees.${name} $<TARGET_FILE:tandem_planted> ${ARGN})
  set_tests_properties(sanitizer.sees.${name} PROPERTIES PASS_REGULAR_EXPRESSION "${report}" FAIL_REGULAR_EXPRESSION
    "nothing was seen")
endfunction()

if(TANDEM_SANITIZE MATCHES address)
  # Whole files of tests (Catch2's tag of a file), of which the command's run the instrumented program.
  # Catch2 names a file without its folder, so files of one name are one test.
  set(files)
  foreach(path IN LISTS reader_tests)
    cmake_path(GET path FILENAME file)
    list(APPEND files ${file})
  endforeach()
  list(REMOVE_DUPLICATES files)
  foreach(file IN LISTS files)
    sanitizer_test(${file} $<TARGET_FILE:tandem_tests> ${fail_without_tests} --filenames-as-tags "[#${file}]")
  endforeach()

  # By one element. Each width that is watched is seen in its own kernels, of which whole vectors are gathered.
  function(sees_overruns name kernels backend)
    foreach(buffer body_velocity bounds counts)
      sanitizer_sees(overrun.${name}.${buffer} "ERROR: AddressSanitizer" overrun ${buffer} ${backend})
    endforeach()
    sanitizer_sees(overrun.${name} "run_items<tandem::${kernels}::" overrun body_orientation ${backend})
    sanitizer_test(exact.${name} $<TARGET_FILE:tandem_planted> exact body_orientation ${backend})
  endfunction()
  file(STRINGS /proc/cpuinfo processor REGEX "^flags" LIMIT_COUNT 1)
  sees_overruns(serial scalar serial)
  sanitizer_sees(overrun.backward "run_groups<tandem::backward::" overrun bounds_sums serial:order=backward)
  sanitizer_test(exact.backward $<TARGET_FILE:tandem_planted> exact bounds_sums serial:order=backward)
  sees_overruns(reference reference reference:threads=1)
  sees_overruns(lanes4 lanes4 tbb:threads=2,lanes=4)
  if(processor MATCHES " avx512dq ")
    sees_overruns(lanes16 lanes16 tbb:threads=2,lanes=16)
  endif()
else()
  sanitizer_sees(race "#0 fill_item" race)
  sanitizer_test(no-race $<TARGET_FILE:tandem_planted> no-race)
endif()
