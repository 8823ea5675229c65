# cmake -D BUILD=... -D SCRATCH=... -P install_test.cmake: what a user of find_package(Tandem) does, from an empty
# folder.
file(REMOVE_RECURSE ${SCRATCH})

function(step)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
  message("${output}")
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "status ${status} from: ${ARGN}")
  endif()
endfunction()

# The prefix is moved after the installation: the package must not know where it was built.
step(${CMAKE_COMMAND} --install ${BUILD} --prefix ${SCRATCH}/first)
file(RENAME ${SCRATCH}/first ${SCRATCH}/prefix)
step(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR}/outside -B ${SCRATCH}/build -G ${GENERATOR}
  -DCMAKE_CXX_COMPILER=${COMPILER} -DCMAKE_PREFIX_PATH=${SCRATCH}/prefix)
step(${CMAKE_COMMAND} --build ${SCRATCH}/build)
foreach(program outside outside_shared compare compare_shared)
  step(${SCRATCH}/build/${program})
endforeach()

# Kernels of the project's own, through the headers and the embedder of the package alone.
step(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR}/wind -B ${SCRATCH}/wind -G ${GENERATOR}
  -DCMAKE_CXX_COMPILER=${COMPILER} -DCMAKE_PREFIX_PATH=${SCRATCH}/prefix)
step(${CMAKE_COMMAND} --build ${SCRATCH}/wind)
execute_process(COMMAND ${SCRATCH}/wind/wind_field RESULT_VARIABLE status OUTPUT_VARIABLE printed)
message("${printed}")
if(NOT status EQUAL 0)
  message(FATAL_ERROR "wind_field ends with status ${status}")
endif()

# docs/your-own-kernel.md holds these files, and what the program prints, to the letter.
file(READ ${CMAKE_CURRENT_LIST_DIR}/../../docs/your-own-kernel.md page)
foreach(file blow.h wind_kernels.def wind_buffers.def CMakeLists.txt main.cpp)
  file(READ ${CMAKE_CURRENT_LIST_DIR}/wind/${file} text)
  string(FIND "${page}" "`${file}`" named)
  string(FIND "${page}" "\n${text}```" found)
  if(named EQUAL -1 OR found EQUAL -1)
    message(FATAL_ERROR "docs/your-own-kernel.md does not show ${file} as it stands in tests/install/wind")
  endif()
endforeach()
string(FIND "${page}" "\n${printed}```" found)
if(found EQUAL -1)
  message(FATAL_ERROR "docs/your-own-kernel.md does not show what the program prints: ${printed}")
endif()

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
