# embed_kernels(target): compiles cl/*.cl, with every include and entry written out, into the target.
set(TANDEM_EMBEDDER_FROM "" CACHE PATH "Build folder of this source whose embed_kernels does for this tree, too")
if(TANDEM_EMBEDDER_FROM)
  add_executable(embed_kernels IMPORTED GLOBAL)
  set_target_properties(embed_kernels PROPERTIES IMPORTED_LOCATION ${TANDEM_EMBEDDER_FROM}/build-tools/embed_kernels)
else()
  file(GLOB embed_sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/tools/embed/*.cpp)
  add_executable(embed_kernels ${embed_sources})
  target_include_directories(embed_kernels PRIVATE ${PROJECT_SOURCE_DIR})
  set_target_properties(embed_kernels PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/build-tools)
endif()

function(embed_kernels target)
  file(GLOB programs CONFIGURE_DEPENDS RELATIVE ${PROJECT_SOURCE_DIR} cl/*.cl)
  file(GLOB_RECURSE included CONFIGURE_DEPENDS shared/*.h shared/*.def cl/*.h)
  list(TRANSFORM programs PREPEND ${PROJECT_SOURCE_DIR}/ OUTPUT_VARIABLE program_files)
  set(folder ${CMAKE_BINARY_DIR}/generated)
  set(generated ${folder}/embedded_kernels.cpp)
  add_custom_command(
    OUTPUT ${generated}
    COMMAND ${CMAKE_COMMAND} -E make_directory ${folder}
    COMMAND embed_kernels ${PROJECT_SOURCE_DIR} ${folder} ${programs}
    DEPENDS embed_kernels ${program_files} ${included}
    COMMENT "Embedding OpenCL kernels"
    VERBATIM)
  target_sources(${target} PRIVATE ${generated})
endfunction()
