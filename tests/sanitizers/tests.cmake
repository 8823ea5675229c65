# The tests of a sanitizer tree (presets asan and tsan): the Catch2 tests tagged [sanitizer], and small runs of the
# command, large enough that every kernel is split over several threads. Drivers of OpenCL are not instrumented: left out.
set(launcher)
if(TANDEM_SANITIZE MATCHES thread)
  # The thread sanitizer of some compilers cannot place its shadow memory under strong address randomisation.
  execute_process(COMMAND setarch -R true RESULT_VARIABLE setarch_failed OUTPUT_QUIET ERROR_QUIET)
  if(NOT setarch_failed)
    set(launcher setarch -R)
  endif()
endif()

function(sanitizer_test name)
  tandem_test(NAME sanitizer.${name} LABEL sanitizer TIMEOUT 300 COMMAND ${launcher} ${ARGN})
endfunction()

sanitizer_test(unit $<TARGET_FILE:tandem_tests> ${fail_without_tests} "[sanitizer]")
if(TARGET tandem_command)
  sanitizer_test(box-grid $<TARGET_FILE:tandem_command> diff box-grid:nx=8,ny=8,nz=8 --between serial,tbb:threads=4 --steps 10)
  sanitizer_test(falling-boxes $<TARGET_FILE:tandem_command> run falling-boxes:n=600 --on tbb:threads=4 --steps 20)
  sanitizer_test(bad-input $<TARGET_FILE:tandem_command> run no-such-scene --on serial)
  set_tests_properties(sanitizer.bad-input PROPERTIES PASS_REGULAR_EXPRESSION "no-such-scene" FAIL_REGULAR_EXPRESSION "Sanitizer|runtime error")
endif()
