# The files of tests that a sanitizer tree runs: those with a test tagged [sanitizer] or [address], and whole files that
# read what others wrote. Files that compile shared/, the dispatcher's threads or what stands in headers of host/base
# into themselves are instrumented (`watched_tests`); the others only call the library (`lent_tests`), and are borrowed
# where there is a tree to borrow from (cmake/Sanitizers.cmake). The tree that lends needs these lists, too, since it
# joins sources (tests/join.cmake).
set(reader_tests io/bad_shapes_test io/contact_problem/file_test io/obj/mesh_test io/gltf/scene_test io/json/scene_test
  scene/scene_test io/gltf/animation_test io/gltf/joints_test io/gltf/solids_test io/gltf/strict_test
  io/mjcf/actuators_test io/mjcf/joints_test io/mjcf/scene_test io/stl/mesh_test io/urdf/scene_test io/urdf/strict_test)
list(TRANSFORM reader_tests PREPEND host/)
list(APPEND reader_tests tools/command/command_test tools/command/hostile_files_test)
set(watched_tests)
set(lent_tests)
foreach(source IN LISTS TEST_SOURCES)
  file(STRINGS ${source} tags REGEX "\\[(sanitizer|address)\\]" LIMIT_COUNT 1)
  file(STRINGS ${source} kernels REGEX "^#include \"(tests/)?shared/|__SANITIZE_" LIMIT_COUNT 1)
  cmake_path(RELATIVE_PATH source BASE_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR} OUTPUT_VARIABLE path)
  cmake_path(REMOVE_EXTENSION path OUTPUT_VARIABLE name)
  if(NOT tags AND NOT name IN_LIST reader_tests)
    continue()
  endif()
  if(kernels OR path MATCHES "^(minicl|host/base)/")
    list(APPEND watched_tests ${source})
  else()
    list(APPEND lent_tests ${source})
  endif()
endforeach()
