# JoinSources.cmake - the sources of one concern are compiled as one, where a tree is built beside others (tools/run-tests.sh).
#
# Most of their time goes into headers that they share. The release tree compiles each by itself, so a source that leans on its
# neighbours' includes fails there. Within a group a name in an unnamed namespace stands once.
set_target_properties(tandem PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
function(join_sources group pattern)
  set(sources ${HOST_SOURCES})
  list(FILTER sources INCLUDE REGEX "/host/(${pattern})[.]cpp$")
  set_source_files_properties(${sources} PROPERTIES UNITY_GROUP ${group})
endfunction()
join_sources(loading "scene_gltf.*|json_reader|scene_json.*|input_file")
join_sources(catalog "scene_catalog.*|scene_talks|primitives")
join_sources(geometry "geometry/.*|hull_buffers|tree_tables")
join_sources(stages "batching/.*|broadphases/.*|step|step_launches|specialise")
join_sources(solvers "solvers/.*")
join_sources(opencl "opencl/.*")
join_sources(world "world|body_buffers|contact_events|queries|memory|layout|launcher|parameters|settings|scene|scene_counts")
join_sources(runtime "backend|backend_list|batch_fault|breakpoint|buffer_place|carried|debug|host_stages|incidence|output_file|shape_bounds|trigonometry")
join_sources(verification "animation|animation_geometry|compare|contact_problem_file|contact_solver|metrics|rounding")
