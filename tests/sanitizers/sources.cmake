# The files of tests that a sanitizer tree runs: those with a test tagged [sanitizer], and whole files that read what
# others wrote. Files that compile shared/ or the dispatcher's threads into themselves are instrumented; the others only
# call the library, and are borrowed where there is a tree to borrow from (cmake/Sanitizers.cmake).
set(reader_tests io/bad_shapes_test io/contact_problem/file_test io/obj/mesh_test io/gltf/scene_test io/json/scene_test
  scene/scene_test io/gltf/solids_test io/gltf/strict_test)
list(TRANSFORM reader_tests PREPEND host/)
list(APPEND reader_tests tools/command/command_test tools/command/hostile_files_test)
set(watched)
set(BORROWED_TESTS)
foreach(source IN LISTS TEST_SOURCES)
  file(STRINGS ${source} tags REGEX "\\[sanitizer\\]" LIMIT_COUNT 1)
  file(STRINGS ${source} kernels REGEX "^#include \"shared/|__SANITIZE_" LIMIT_COUNT 1)
  cmake_path(RELATIVE_PATH source BASE_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR} OUTPUT_VARIABLE path)
  cmake_path(REMOVE_EXTENSION path OUTPUT_VARIABLE name)
  if(NOT tags AND NOT name IN_LIST reader_tests)
    continue()
  endif()
  if(TANDEM_OBJECTS_FROM AND NOT kernels AND NOT path MATCHES "^minicl/")
    list(APPEND BORROWED_TESTS ${TANDEM_OBJECTS_FROM}/tests/CMakeFiles/tandem_tests.dir/${path}.o)
  else()
    list(APPEND watched ${source})
  endif()
endforeach()
if(TANDEM_OBJECTS_FROM)
  set(TEST_RUNNER ${TANDEM_OBJECTS_FROM}/tests/CMakeFiles/tandem_test_runner.dir/main.cpp.o)
endif()
set_source_files_properties(${BORROWED_TESTS} ${TEST_RUNNER} PROPERTIES EXTERNAL_OBJECT TRUE GENERATED TRUE)
set_source_files_properties(${watched} PROPERTIES COMPILE_OPTIONS "-O0") # a third of the time of -O1
set(TEST_SOURCES ${watched})
