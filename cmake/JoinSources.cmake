# JoinSources.cmake - the sources of one concern are compiled as one, since most of their time goes into headers that
# they share. Within a group a name in an unnamed namespace stands once.
function(join_sources group pattern)
  set(sources ${HOST_SOURCES})
  list(FILTER sources INCLUDE REGEX "/host/(${pattern})[.]cpp$")
  set_source_files_properties(${sources} PROPERTIES UNITY_GROUP ${group})
endfunction()

# The readers and writers of files are joined in every tree: the headers of JSON take longest.
set_target_properties(tandem_io_objects PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
join_sources(gltf "io/gltf/.*|io/input_file")
join_sources(json "io/json/.*|io/obj/.*")
join_sources(robots "io/(articulated|mjcf|stl|urdf|xml)/.*")
join_sources(catalog "catalog/.*")
join_sources(written "io/glb/.*|io/contact_problem/.*|io/output_file")

# The others are joined where a tree is built beside others (tools/run-tests.sh). The presets for daily work compile
# each by itself, so a source that leans on its neighbours' includes fails there, and only there.
if(NOT TANDEM_JOIN_SOURCES)
  return()
endif()
foreach(library IN LISTS libraries)
  set_target_properties(${library}_objects PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
endforeach()
join_sources(geometry "base/.*|geometry/.*")
join_sources(pipeline "pipeline/[^/]*|pipeline/batching/.*|pipeline/broadphases/.*")
join_sources(solvers "pipeline/solvers/.*")
join_sources(opencl "runtime/opencl/.*")
join_sources(world "world/.*")
join_sources(scene "scene/.*")
join_sources(runtime "runtime/[^/]*|runtime/interface/.*")
join_sources(verification "verify/.*")
# Programs for gdb bring their own, unoptimised (tests/debugging).
set_source_files_properties(${PROJECT_SOURCE_DIR}/host/runtime/interface/debug.cpp PROPERTIES
  SKIP_UNITY_BUILD_INCLUSION ON)
# The headers of shared/ in double do not go together with those that others include in float.
set_source_files_properties(${PROJECT_SOURCE_DIR}/host/scene/articulations.cpp
  ${PROJECT_SOURCE_DIR}/host/world/joint_coordinates.cpp PROPERTIES
  SKIP_UNITY_BUILD_INCLUSION ON)
# TBB's headers and the macros of shared/ do not go together.
set_source_files_properties(${PROJECT_SOURCE_DIR}/host/runtime/parts.cpp
  ${PROJECT_SOURCE_DIR}/host/runtime/part_threads.cpp PROPERTIES
  SKIP_UNITY_BUILD_INCLUSION ON)
