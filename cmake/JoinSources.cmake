# JoinSources.cmake - the sources of one concern are compiled as one, where a tree is built beside others
# (tools/run-tests.sh).
#
# Most of their time goes into headers that they share. The release tree compiles each by itself, so a source that leans
# on its neighbours' includes fails there. Within a group a name in an unnamed namespace stands once.
foreach(library IN LISTS libraries)
  set_target_properties(${library}_objects PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
endforeach()
function(join_sources group pattern)
  set(sources ${HOST_SOURCES})
  list(FILTER sources INCLUDE REGEX "/host/(${pattern})[.]cpp$")
  set_source_files_properties(${sources} PROPERTIES UNITY_GROUP ${group})
endfunction()
join_sources(gltf "io/gltf/.*|io/input_file")
join_sources(json "io/json/.*|io/obj/.*")
join_sources(catalog "catalog/.*")
join_sources(geometry "base/.*|geometry/.*")
join_sources(pipeline "pipeline/[^/]*|pipeline/batching/.*|pipeline/broadphases/.*")
join_sources(solvers "pipeline/solvers/.*")
join_sources(opencl "runtime/opencl/.*")
join_sources(world "world/.*|scene/.*")
join_sources(runtime "runtime/[^/]*|runtime/interface/.*")
join_sources(verification "verify/.*")
join_sources(written "io/glb/.*|io/contact_problem/.*|io/output_file")
# Programs for gdb bring their own, unoptimised (tests/debugging).
set_source_files_properties(${PROJECT_SOURCE_DIR}/host/runtime/interface/debug.cpp PROPERTIES
  SKIP_UNITY_BUILD_INCLUSION ON)
