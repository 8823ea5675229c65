# cmake -D SOURCE=... -D SCRATCH=... -D EMBEDDER_FROM=... -P configure_test.cmake: what TANDEM_FEATURES says where a
# name is wrong, and what it writes where all are right.
file(REMOVE_RECURSE ${SCRATCH})
function(configure features)
  execute_process(COMMAND ${CMAKE_COMMAND} -S ${SOURCE} -B ${SCRATCH} -G ${GENERATOR} -DCMAKE_CXX_COMPILER=${COMPILER}
    -DTANDEM_EMBEDDER_FROM=${EMBEDDER_FROM} -DTANDEM_BUILD_COMMAND=OFF -DTANDEM_BUILD_TESTS=OFF
    "-DTANDEM_FEATURES=${features}" RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE error)
  set(status ${status} PARENT_SCOPE)
  set(error "${error}" PARENT_SCOPE)
endfunction()

configure("spheres;LOKCS")
set(features "Features: SPHERE_SPHERE, [A-Z_, ]*, LOCKS, [A-Z_, ]*, AVBD[A-Z_, ]*[.]")
set(groups "Groups: spheres, boxes, [a-z_, ]*[.]")
if(status EQUAL 0 OR NOT error MATCHES "\n *TANDEM_FEATURES: 'LOKCS' is no feature[.] ${features} ${groups}\n")
  message(FATAL_ERROR "status ${status} from a wrong name, and not one line with the right ones: ${error}")
endif()

configure("spheres;LOCKS")
if(NOT status EQUAL 0)
  message(FATAL_ERROR "status ${status}: ${error}")
endif()
file(READ ${SCRATCH}/generated/built/features.h built)
file(STRINGS ${SCRATCH}/build.ninja lines REGEX "(-DTANDEM_SOME_FEATURES|--without )")
foreach(expected "BUILT_OPTION \"spheres;LOCKS\"" "BUILT_SPHERE_SPHERE 1" "BUILT_LOCKS 1" "BUILT_BOX_BOX 0")
  if(NOT built MATCHES "#define ${expected}\n")
    message(FATAL_ERROR "built/features.h has no line '#define ${expected}': ${built}")
  endif()
endforeach()
if(NOT lines MATCHES "-DTANDEM_SOME_FEATURES" OR NOT lines MATCHES "--without SPHERE_BOX,BOX_BOX,")
  message(FATAL_ERROR "neither kernels nor embedded programs are told what is left out: ${lines}")
endif()
