# tandem_heap_tests: tests with operators new and delete of their own (heap/allocations.h), hence a program of their
# own.
#
# It is in the tree of the address sanitizer, too, which watches what these operators take from malloc: all that it
# cannot tell here is a new without its own delete. In the tree of the thread sanitizer it would show nothing that other
# tests do not.
# Called by heap/command.cpp.
set_source_files_properties(../tools/command/main.cpp PROPERTIES COMPILE_DEFINITIONS main=command_main)
set(heap_sources heap/command.cpp heap/files.cpp heap/worlds.cpp heap/allocations.cpp ../tools/command/main.cpp)
if(TANDEM_OBJECTS_FROM)
  string(REPLACE "../" "__/" heap_objects "${heap_sources}")
  list(TRANSFORM heap_objects REPLACE "(.+)" "${TANDEM_OBJECTS_FROM}/tests/CMakeFiles/tandem_heap_tests.dir/\\1.o")
  set_source_files_properties(${heap_objects} PROPERTIES EXTERNAL_OBJECT TRUE GENERATED TRUE)
  set(heap_sources ${heap_objects})
endif()
if(TARGET probe) # no test of it is for sanitizers, whose trees have no module
  list(APPEND heap_sources heap/long_run.cpp heap/malloc_calls.cpp heap/steady_steps.cpp)
endif()
tandem_catch2_tests(tandem_heap_tests ${heap_sources})
if(TARGET probe)
  target_link_libraries(tandem_heap_tests PRIVATE probe)
endif()
