# The tests of a sanitizer tree (presets asan and tsan): the Catch2 tests tagged [sanitizer], among them scenes large
# enough that kernels are split over several threads. Drivers of OpenCL are not instrumented: left out.
set(launcher)
if(TANDEM_SANITIZE MATCHES thread)
  # The thread sanitizer of some compilers cannot place its shadow memory under strong address randomisation.
  execute_process(COMMAND setarch -R true RESULT_VARIABLE setarch_failed OUTPUT_QUIET ERROR_QUIET)
  if(NOT setarch_failed)
    set(launcher setarch -R)
  endif()
endif()

function(sanitizer_test name)
  tandem_test(NAME sanitizer.${name} LABEL sanitizer TIMEOUT 900 COMMAND ${launcher} ${ARGN})
endfunction()

sanitizer_test(unit $<TARGET_FILE:tandem_tests> ${fail_without_tests} "[sanitizer]")
