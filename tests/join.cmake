# join.cmake - the tests of one concern are compiled as one source, since three quarters of the time of one alone go
# into templates that its neighbours instantiate, too: Catch2, Eigen, the containers. Within a group a name in an
# unnamed namespace stands once; a file that has no group is compiled by itself.
#
# What sanitizer trees run is grouped apart: they compile the one part anew and link the other as it is, and objects
# that hold other tests besides would bring those, too.
function(join_tests tests group pattern)
  set(joined ${${tests}})
  list(FILTER joined INCLUDE REGEX "^${CMAKE_CURRENT_SOURCE_DIR}/(${pattern})")
  set_source_files_properties(${joined} PROPERTIES UNITY_GROUP ${group})
endfunction()

join_tests(watched_tests watched ".*")
join_tests(lent_tests lent_worlds "host/(include|runtime|scene|world)/|physics/")
# Each of these has names that its neighbours use for something else.
foreach(name call_faults combinations locks properties shapes snapshot state_ring threads)
  join_tests(lent_tests lent_${name} "host/world/${name}_test")
endforeach()
join_tests(lent_tests lent_recording "host/world/recording_test")
join_tests(lent_tests lent_geometry "host/geometry/")
join_tests(lent_tests lent_files "host/io/|tools/")
join_tests(lent_tests lent_robots "host/io/(mjcf|stl|urdf)/")
join_tests(lent_tests lent_parity "parity/")
foreach(source IN LISTS lent_tests) # objects are borrowed by the names of groups
  get_source_file_property(group ${source} UNITY_GROUP)
  if(NOT group)
    message(FATAL_ERROR "${source}: a test that is lent to sanitizer trees has no group in tests/join.cmake")
  endif()
endforeach()

set(other_tests ${TEST_SOURCES})
list(REMOVE_ITEM other_tests ${watched_tests} ${lent_tests})
join_tests(other_tests host "(host|minicl)/")
join_tests(other_tests values "host/(base|catalog|geometry|verify)/")
join_tests(other_tests world "host/world/")
join_tests(other_tests module "module/")
join_tests(other_tests parity "parity/")
join_tests(other_tests physics "physics/")
join_tests(other_tests collision
  "physics/(compounds|continuous|gltf_scenes|hits|meshes|misses|misses_in_flight|overlap|seams|shapes.*)_")
join_tests(other_tests solvers "physics/(body_coloring|mass_split|reference|reference_solve|solvers_.*|stiff_bodies)_")
join_tests(other_tests joints "((host/(io|scene|verify|world)|parity|physics)/(json/)?joint)")
join_tests(other_tests joint_calls "(parity|physics)/joint_calls")
join_tests(other_tests couplings "(host/scene|parity|physics)/coupling")
join_tests(other_tests articulations "(parity|physics)/articulations")
join_tests(other_tests shared "shared/(broadphase|midphase|parallel)/")
join_tests(other_tests narrowphase "shared/narrowphase/")
join_tests(other_tests convex "shared/narrowphase/(conservative|convex|cube|gjk|hull|libccd)_")
join_tests(other_tests tools "tools/(bench|command|diff|embed|plot)/")
join_tests(other_tests recording_command "tools/command/(bench_controls|bench_left_out|bench_scenes|recording)_test")
join_tests(other_tests stability "tools/stability/")
# These compile what their neighbours have under the same names: shared/ in double, its trees beside the host's, and
# vectors of hulls.
set_source_files_properties(host/geometry/fine_hulls_test.cpp
  shared/narrowphase/convex_reference_test.cpp shared/midphase/subtree_pairs_test.cpp
  shared/articulations/articulations_test.cpp shared/articulations/articulations_motion_test.cpp
  shared/articulations/articulations_float_test.cpp PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
# Its times are those of code that is optimised as kernels are.
set_source_files_properties(shared/articulations/articulations_time_test.cpp PROPERTIES
  SKIP_UNITY_BUILD_INCLUSION ON SKIP_PRECOMPILE_HEADERS ON COMPILE_OPTIONS -O2)
