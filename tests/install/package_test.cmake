# cmake -D BUILD=... -D SCRATCH=... -P package_test.cmake: what a user of find_package(Tandem) does, from an empty
# folder. Other tests use the package after it.
include(${CMAKE_CURRENT_LIST_DIR}/steps.cmake)
file(REMOVE_RECURSE ${SCRATCH})

# The prefix is moved after the installation: the package must not know where it was built.
step(${CMAKE_COMMAND} --install ${BUILD} --prefix ${SCRATCH}/first)
file(RENAME ${SCRATCH}/first ${SCRATCH}/prefix)
configure(${CMAKE_CURRENT_LIST_DIR}/outside ${SCRATCH}/build)
step(${CMAKE_COMMAND} --build ${SCRATCH}/build)
foreach(program outside outside_shared compare compare_shared)
  step(${SCRATCH}/build/${program})
endforeach()

# Physics needs TBB and OpenCL alone, and exports nothing but its own names.
execute_process(COMMAND readelf -d ${SCRATCH}/prefix/lib/libtandem.so OUTPUT_VARIABLE needed
  COMMAND_ERROR_IS_FATAL ANY)
string(REGEX MATCHALL "Shared library: \\[[^]]*" needed "${needed}")
foreach(library IN LISTS needed)
  if(NOT library MATCHES "\\[(libtbb|libOpenCL|libstdc\\+\\+|libm|libgcc_s|libc|ld-linux)")
    message(FATAL_ERROR "libtandem.so needs more than TBB and OpenCL: ${library}")
  endif()
endforeach()
execute_process(COMMAND nm -DC --defined-only ${SCRATCH}/prefix/lib/libtandem.so OUTPUT_VARIABLE exported
  COMMAND_ERROR_IS_FATAL ANY)
string(REGEX MATCHALL "[0-9a-f]+ [TDBR] [^\n]*" exported "${exported}")
list(LENGTH exported count)
if(count LESS 30)
  message(FATAL_ERROR "libtandem.so exports ${count} names: nothing was looked at")
endif()
foreach(symbol IN LISTS exported)
  if(NOT symbol MATCHES " tandem::| (typeinfo|vtable|typeinfo name) for tandem::")
    message(FATAL_ERROR "libtandem.so exports what is not its own: ${symbol}")
  endif()
endforeach()
