# Libraries.cmake - what a program links: Tandem::tandem (physics), Tandem::io (files and built-in scenes) and
# Tandem::verify (comparison of backends, metrics), each static and shared.
#
#   Tandem::verify  ->  Tandem::io  ->  Tandem::tandem  ->  TBB, OpenCL
#
# Both forms are made of the same objects, so that one compilation serves the tests and the command, which look inside
# the static ones, and a program that wants shared ones (Tandem::tandem_shared and so on). Symbols are hidden but for
# what is marked TANDEM_API (host/include/tandem/export.h).
option(TANDEM_SHARED_LIBRARIES "Link the shared libraries, too" ON)
if(TANDEM_SANITIZE OR NOT TANDEM_BUILD_COMMAND)
  set(TANDEM_SHARED_LIBRARIES OFF)
endif()

# tandem_library(NAME name SOURCES source... LINKS library... USES library...): `name`_objects, `name` and
# `name`_shared. LINKS are other libraries of ours, which its users link, too; USES stay inside.
function(tandem_library)
  cmake_parse_arguments(library "" "NAME" "SOURCES;LINKS;USES" ${ARGN})
  set(objects ${library_NAME}_objects)
  add_library(${objects} OBJECT ${library_SOURCES})
  set_target_properties(${objects} PROPERTIES CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON
    POSITION_INDEPENDENT_CODE ON)
  target_include_directories(${objects} PRIVATE ${PROJECT_SOURCE_DIR}/host/include ${PROJECT_SOURCE_DIR})
  target_link_libraries(${objects} PRIVATE TBB::tbb tandem_compiled_in ${library_USES})
  # Where a tree is built beside others, its headers are parsed once. The presets for daily work do without, so that
  # they show a source that lacks an include.
  if(TANDEM_PRECOMPILE_HEADERS)
    target_precompile_headers(${objects} PRIVATE <algorithm> <array> <cmath> <functional> <map> <memory> <optional>
      <span> <string> <vector> <fmt/format.h>)
  endif()
  set(forms STATIC)
  if(TANDEM_SHARED_LIBRARIES)
    list(APPEND forms SHARED)
  endif()
  foreach(form IN LISTS forms)
    set(suffix)
    if(form STREQUAL SHARED)
      set(suffix _shared)
    endif()
    set(target ${library_NAME}${suffix})
    add_library(${target} ${form} $<TARGET_OBJECTS:${objects}>)
    string(REPLACE tandem_ "" exported ${target})
    if(library_NAME STREQUAL tandem)
      set(exported ${target})
    endif()
    add_library(Tandem::${exported} ALIAS ${target})
    set_target_properties(${target} PROPERTIES OUTPUT_NAME ${library_NAME} EXPORT_NAME ${exported}
      VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
    target_include_directories(${target} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/host/include>
      $<INSTALL_INTERFACE:include>)
    target_compile_features(${target} PUBLIC cxx_std_20)
    # Headers that a user includes compute, too; a processor with fused multiply-add would round differently there.
    target_compile_options(${target} INTERFACE $<$<COMPILE_LANG_AND_ID:CXX,GNU,Clang>:-ffp-contract=off>)
    list(TRANSFORM library_LINKS APPEND "${suffix}" OUTPUT_VARIABLE links)
    target_link_libraries(${target} PUBLIC ${links} PRIVATE ${library_USES})
    if(form STREQUAL SHARED) # what is missing is said here, not to a user
      target_link_options(${target} PRIVATE -Wl,--no-undefined)
    endif()
  endforeach()
endfunction()

# What is compiled into the libraries, so that who links Tandem::tandem needs TBB and OpenCL alone: headers of fmt
# (host/base/format.cpp has the rest of it) and Eigen.
add_library(tandem_compiled_in INTERFACE)
foreach(package fmt::fmt Eigen3::Eigen)
  target_include_directories(tandem_compiled_in SYSTEM INTERFACE
    $<TARGET_PROPERTY:${package},INTERFACE_INCLUDE_DIRECTORIES>)
endforeach()

file(GLOB_RECURSE HOST_SOURCES CONFIGURE_DEPENDS host/*.cpp)
file(GLOB MINICL_SOURCES CONFIGURE_DEPENDS minicl/*.cpp minicl/finding/*.cpp)
if(TANDEM_PORTABLE_KERNELS_ONLY)
  list(FILTER MINICL_SOURCES EXCLUDE REGEX "(lanes8|lanes16|scalar_avx2|backward|reference|reference_storage)[.]cpp$")
endif()
set(TANDEM_KERNEL_OPTIONS "" CACHE STRING "Options of the compiler for the kernels of the CPU alone")
set_source_files_properties(${MINICL_SOURCES} PROPERTIES SKIP_PRECOMPILE_HEADERS ON
  COMPILE_OPTIONS "-Wno-float-conversion;${TANDEM_KERNEL_OPTIONS}")
set(io_sources ${HOST_SOURCES})
list(FILTER io_sources INCLUDE REGEX "/host/(io|catalog)/")
set(verify_sources ${HOST_SOURCES})
list(FILTER verify_sources INCLUDE REGEX "/host/verify/")
set(physics_sources ${HOST_SOURCES} ${MINICL_SOURCES})
list(REMOVE_ITEM physics_sources ${io_sources} ${verify_sources})
if(NOT TANDEM_BUILD_COMMAND) # what only the command writes
  list(FILTER io_sources EXCLUDE REGEX "/io/(glb|contact_problem)/")
endif()

tandem_library(NAME tandem SOURCES ${physics_sources} USES TBB::tbb OpenCL::OpenCL)
tandem_library(NAME tandem_io SOURCES ${io_sources} LINKS tandem
  USES fmt::fmt TinyGLTF::TinyGLTF tinyobjloader::tinyobjloader tinyxml2::tinyxml2
  $<BUILD_INTERFACE:nlohmann_json::nlohmann_json>)
set(libraries tandem tandem_io)
if(TANDEM_BUILD_COMMAND)
  tandem_library(NAME tandem_verify SOURCES ${verify_sources} LINKS tandem_io tandem USES fmt::fmt)
  list(APPEND libraries tandem_verify)
endif()
# No double becomes a float unseen (host/include/tandem/round_to_float.h); kernels in double are rounded where they
# store.
foreach(library IN LISTS libraries)
  target_compile_options(${library}_objects PRIVATE -Wfloat-conversion)
endforeach()
if(TANDEM_PORTABLE_KERNELS_ONLY)
  target_compile_definitions(tandem_objects PRIVATE TANDEM_PORTABLE_KERNELS_ONLY)
endif()

set(TANDEM_OBJECTS_FROM "" CACHE PATH
  "Build folder of this source, from which trees of sanitizers and of other compilers take what they need not compile")

# The objects of this tree before all others, which a build folder named by TANDEM_OBJECTS_FROM has, too.
function(link_own_libraries_first target)
  set(files)
  foreach(library IN LISTS libraries)
    string(PREPEND files "$<TARGET_FILE:${library}> ")
  endforeach()
  target_link_options(${target} PRIVATE "SHELL:-Wl,--whole-archive ${files}-Wl,--no-whole-archive")
endfunction()
include(cmake/JoinSources.cmake)
set(features_left_out)
if(TANDEM_FEATURES)
  build_features("${TANDEM_FEATURES}" features_left_out)
endif()
embed_kernels(tandem_objects ${features_left_out})
