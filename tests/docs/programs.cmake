# programs.cmake - what apply_pages.sh builds in its copy of the tree: the tests that the pages add, and the command as
# far as they run it, compiled as one.
find_package(Catch2 REQUIRED)
set_source_files_properties(${TANDEM_TEST_RUNNER} tools/plot/chart.cpp PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
if(TANDEM_TEST_RUNNER MATCHES "[.]o$")
  set_source_files_properties(${TANDEM_TEST_RUNNER} PROPERTIES EXTERNAL_OBJECT ON)
endif()
add_executable(page_tests ${TANDEM_PAGE_TESTS} ${TANDEM_TEST_RUNNER})
add_executable(page_command tests/docs/page_command.cpp tools/command/distinct_files.cpp tools/command/output.cpp
  tools/command/placement_text.cpp tools/command/progress.cpp tools/command/scene_options.cpp tools/diff/diff.cpp
  tools/plan/columns.cpp tools/plan/facts.cpp tools/plan/plan.cpp tools/plan/plan_picture.cpp tools/plot/chart.cpp
  tools/plot/markup.cpp tools/replay/recording_file.cpp)
foreach(program page_tests page_command)
  set_target_properties(${program} PROPERTIES UNITY_BUILD ON)
  target_include_directories(${program} PRIVATE ${PROJECT_SOURCE_DIR})
  target_link_libraries(${program} PRIVATE tandem_verify tandem_io tandem tandem_dependencies CLI11::CLI11
    Catch2::Catch2)
endforeach()
