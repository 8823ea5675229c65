# What a sanitizer tree (presets asan and tsan) watches, and what it need not compile.
#
# Where addresses are watched, the library is instrumented whole, with the loaders, and of the command what a hostile
# input passes through; where threads are, what they share. Other tools and most tests only call it: with
# TANDEM_OBJECTS_FROM they are the objects of a tree without sanitizers, of the same source and compiler, and take no
# time. The library is linked before them, so that of inline functions in both, its are taken.

# leave_unwatched(kernels... [SOURCES regex...]): these sources of minicl/ and those whose paths match come from
# TANDEM_OBJECTS_FROM; without it the kernels are compiled here, but not instrumented.
function(leave_unwatched)
  cmake_parse_arguments(unwatched "" "" "SOURCES" ${ARGN})
  list(JOIN unwatched_UNPARSED_ARGUMENTS "|" kernels)
  list(JOIN unwatched_SOURCES "|" sources)
  set(pattern "minicl/(finding/)?(${kernels})[.]cpp$")
  if(sources)
    string(APPEND pattern "|${sources}")
  endif()
  if(NOT TANDEM_OBJECTS_FROM)
    list(TRANSFORM unwatched_UNPARSED_ARGUMENTS REPLACE "(.+)" "minicl/\\1.cpp;minicl/finding/\\1.cpp" OUTPUT_VARIABLE
      files)
    set_property(SOURCE ${files} DIRECTORY ${PROJECT_SOURCE_DIR} APPEND PROPERTY COMPILE_OPTIONS "-fno-sanitize=all")
    return()
  endif()
  foreach(library IN LISTS libraries)
    get_target_property(library_sources ${library}_objects SOURCES)
    list(FILTER library_sources EXCLUDE REGEX "${pattern}")
    set_property(TARGET ${library}_objects PROPERTY SOURCES ${library_sources})
    # which gives what is missing, and no more
    target_link_libraries(${library} PUBLIC $<BUILD_INTERFACE:${TANDEM_OBJECTS_FROM}/lib${library}.a>)
  endforeach()
endfunction()

# scalar.cpp is watched for all that the sanitizers know. The other widths and orders are the same source: only what
# depends on them, accesses to buffers, is watched there, by calls: a seventh of the compile time (lanes8.cpp: 54 s for
# all, 7 s so). Of widths the least and the greatest are, and not the one between.
set(same_kernels scalar_avx2.cpp backward.cpp reference.cpp lanes4.cpp lanes16.cpp)
list(TRANSFORM same_kernels REPLACE "(.+)" "minicl/\\1;minicl/finding/\\1")
if(TANDEM_SANITIZE MATCHES address)
  set_property(SOURCE host/io/gltf/document.cpp host/io/gltf/mesh.cpp APPEND PROPERTY COMPILE_OPTIONS
    "-fsanitize=alignment")
  set_property(SOURCE ${same_kernels} APPEND PROPERTY COMPILE_OPTIONS "-fno-sanitize=undefined")
  if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
    set_property(SOURCE ${same_kernels} APPEND PROPERTY COMPILE_OPTIONS
      "--param=asan-stack=0;--param=asan-instrumentation-with-call-threshold=0")
  endif()
  leave_unwatched(lanes8)
elseif(TANDEM_SANITIZE MATCHES thread)
  # Threads share the rows of lanes4.cpp and scalar.cpp as they do those of the others. What reads files and builds
  # shapes has no threads, and the drivers of OpenCL are left out.
  leave_unwatched(lanes8 lanes16 backward reference SOURCES "/embedded_kernels[.]cpp$"
    "host/(base|geometry|io|scene|runtime/opencl)/") # whole groups of cmake/JoinSources.cmake
endif()

set(watched_tools tools/command/output.cpp)
if(TANDEM_SANITIZE MATCHES address) # the command has one thread of its own
  list(APPEND watched_tools tools/plot/image.cpp ${reading_tools})
endif()
set_source_files_properties(tools/command/main.cpp PROPERTIES COMPILE_OPTIONS "-O0")
set(borrowed_tools)
if(TANDEM_OBJECTS_FROM)
  set(borrowed_tools ${TANDEM_OBJECTS_FROM}/libtandem_tools.a)
endif()
