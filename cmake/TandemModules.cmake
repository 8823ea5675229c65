# TandemModules.cmake - tandem_add_module(): a library of kernels of your own (docs/your-own-kernel.md).
#
#   tandem_add_module(NAME KERNELS list.def [BUFFERS list.def] [HEADERS item.h ...] [LANES_HEADERS lanes.h ...]
#                     [LINK target])
#
# NAME is a word of C, no stage of the pipeline, and the stage of every row in KERNELS. HEADERS hold the functions of
# ITEM and GROUP kernels, LANES_HEADERS those of LANES, LANES_PADDED and LANES_GROUP kernels, which are compiled in
# every width. Whoever links the library NAME includes "NAME.h": NAME::module(), NAME::kernel::ROW() and
# NAME::buffer::ROW(). LINK is Tandem::tandem_shared where the shared form is wanted.
#
# TANDEM_MODULE_ROOT (shared/, minicl/ and host/runtime/interface/ lie there) and TANDEM_MODULE_TEMPLATES are set by who
# includes this file: the tree itself, or the installed package.

# What every kernel is compiled with, the pipeline's too: contraction of a*b+c into one rounding is what CPU and GPU
# compilers disagree on most (docs/exactness.md).
function(tandem_kernel_options exact avx512)
  set(${exact} -ffp-contract=off -fno-fast-math -fno-math-errno PARENT_SCOPE)
  set(${avx512} -mavx512f -mavx512vl -mavx512dq -mavx512bw -mprefer-vector-width=512 PARENT_SCOPE)
endfunction()

# The ways in which MiniCL compiles the same source: name, lanes, what is defined besides, and a condition.
function(tandem_module_width module width lanes defines condition options)
  set(WIDTH ${module}_${width})
  set(LANES_LINE "")
  set(HEADERS_FILE ${module}_headers.h)
  set(LANES ${lanes})
  if(lanes GREATER 1)
    set(LANES_LINE "#define TANDEM_LANES ${lanes}")
    set(HEADERS_FILE ${module}_lanes_headers.h)
  endif()
  set(DEFINES "${defines}")
  set(CONDITION "${condition}")
  configure_file(${TANDEM_MODULE_TEMPLATES}/width.cpp.in ${MODULE_FOLDER}/${WIDTH}.cpp @ONLY)
  set_source_files_properties(${MODULE_FOLDER}/${WIDTH}.cpp PROPERTIES COMPILE_OPTIONS "${options}"
    OBJECT_DEPENDS "${MODULE_KERNELS}" SKIP_PRECOMPILE_HEADERS ON)
  set(module_widths ${module_widths} ${MODULE_FOLDER}/${WIDTH}.cpp PARENT_SCOPE)
endfunction()

function(tandem_module_headers file)
  set(text "")
  foreach(header IN LISTS ARGN)
    string(APPEND text "#include \"${header}\"\n")
  endforeach()
  file(CONFIGURE OUTPUT ${file} CONTENT "${text}" @ONLY)
endfunction()

function(tandem_add_module module)
  cmake_parse_arguments(MODULE "" "KERNELS;BUFFERS;LINK" "HEADERS;LANES_HEADERS" ${ARGN})
  if(NOT module MATCHES "^[A-Za-z_][A-Za-z0-9_]*$" OR NOT MODULE_KERNELS)
    message(FATAL_ERROR "tandem_add_module(${module} ...): a name that is a word of C, and KERNELS list.def")
  endif()
  if("${module}.h" IN_LIST MODULE_HEADERS OR "${module}.h" IN_LIST MODULE_LANES_HEADERS)
    message(FATAL_ERROR "tandem_add_module(${module} ...): ${module}.h is the header that is generated; call yours "
      "something else")
  endif()
  if(NOT MODULE_LINK)
    set(MODULE_LINK Tandem::tandem)
  endif()
  set(MODULE_FOLDER ${CMAKE_CURRENT_BINARY_DIR}/${module}_module)
  set(MODULE_SOURCES ${CMAKE_CURRENT_SOURCE_DIR})
  if(NOT MODULE_BUFFERS)
    set(MODULE_BUFFERS ${module}_no_buffers.def)
    set(MODULE_BUFFERS_PATH ${MODULE_FOLDER}/${MODULE_BUFFERS})
    file(CONFIGURE OUTPUT ${MODULE_BUFFERS_PATH} CONTENT "/* no buffers */\n" @ONLY)
  else()
    get_filename_component(MODULE_BUFFERS_PATH ${MODULE_BUFFERS} ABSOLUTE)
  endif()
  get_filename_component(MODULE_KERNELS ${MODULE_KERNELS} ABSOLUTE)
  set(MODULE ${module})
  tandem_module_headers(${MODULE_FOLDER}/${module}_headers.h ${MODULE_HEADERS} ${MODULE_LANES_HEADERS})
  tandem_module_headers(${MODULE_FOLDER}/${module}_lanes_headers.h ${MODULE_LANES_HEADERS})
  configure_file(${TANDEM_MODULE_TEMPLATES}/module.h.in ${MODULE_FOLDER}/include/${module}.h @ONLY)
  configure_file(${TANDEM_MODULE_TEMPLATES}/module.cpp.in ${MODULE_FOLDER}/${module}_module.cpp @ONLY)
  configure_file(${TANDEM_MODULE_TEMPLATES}/module.cl.in ${MODULE_FOLDER}/${module}.cl @ONLY)

  tandem_kernel_options(exact avx512_options)
  set(avx2)
  set(avx512)
  if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
    set(avx2 -mavx2)
    set(avx512 ${avx512_options})
  endif()
  set(module_widths)
  set(not_uninitialized -Wno-uninitialized $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>) # GCC bug 105593
  tandem_module_width(${module} scalar 1 "" "1" "")
  tandem_module_width(${module} scalar_avx2 1 "" "1" "${avx2}")
  tandem_module_width(${module} backward 1 "#define TANDEM_BACKWARD" "1" "")
  tandem_module_width(${module} reference 1 "#define TANDEM_REFERENCE" "1" "")
  tandem_module_width(${module} lanes4 4 "" "1" "${not_uninitialized}")
  tandem_module_width(${module} lanes8 8 "" "defined(__AVX2__)" "${avx2};${not_uninitialized}")
  tandem_module_width(${module} lanes16 16 "" "defined(__AVX512F__)" "${avx512};${not_uninitialized}")

  set(embedder embed_kernels)
  if(TARGET Tandem::embed_kernels)
    set(embedder Tandem::embed_kernels)
  endif()
  file(RELATIVE_PATH kernels ${MODULE_SOURCES} ${MODULE_KERNELS})
  file(RELATIVE_PATH buffers ${MODULE_SOURCES} ${MODULE_BUFFERS_PATH})
  add_custom_command(
    OUTPUT ${MODULE_FOLDER}/generated/${module}_programs.cpp
    COMMAND ${CMAKE_COMMAND} -E make_directory ${MODULE_FOLDER}/generated
    COMMAND ${embedder} ${TANDEM_MODULE_ROOT} ${MODULE_FOLDER}/generated --module ${module} ${MODULE_SOURCES}
      ${kernels} ${buffers} ${MODULE_FOLDER}/${module}.cl
    DEPENDS ${embedder} ${MODULE_KERNELS} ${MODULE_BUFFERS_PATH} ${MODULE_FOLDER}/${module}.cl
    DEPFILE ${MODULE_FOLDER}/generated/${module}_programs.cpp.d # every header, those of headers too
    COMMENT "Embedding OpenCL kernels of ${module}"
    VERBATIM)

  add_library(${module} STATIC ${module_widths} ${MODULE_FOLDER}/${module}_module.cpp
    ${MODULE_FOLDER}/generated/${module}_programs.cpp)
  set_target_properties(${module} PROPERTIES POSITION_INDEPENDENT_CODE ON CXX_EXTENSIONS ON)
  target_compile_features(${module} PUBLIC cxx_std_20)
  target_compile_options(${module} PRIVATE ${exact}
    $<$<CXX_COMPILER_ID:GNU>:-fno-tree-slp-vectorize>)
  target_include_directories(${module} PUBLIC ${MODULE_FOLDER}/include
    PRIVATE ${MODULE_FOLDER} ${MODULE_SOURCES} ${TANDEM_MODULE_ROOT})
  target_link_libraries(${module} PUBLIC ${MODULE_LINK})
endfunction()
