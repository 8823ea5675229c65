# embed_kernels(target): compiles cl/*.cl, with every include expanded, into the target.
add_executable(embed_kernels ${PROJECT_SOURCE_DIR}/tools/embed/embed_kernels.cpp)
set_target_properties(embed_kernels PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/build-tools)

function(embed_kernels target)
  file(GLOB programs CONFIGURE_DEPENDS RELATIVE ${PROJECT_SOURCE_DIR} cl/*.cl)
  file(GLOB_RECURSE included CONFIGURE_DEPENDS shared/*.h shared/*.def cl/*/*.cl cl/*.h)
  list(TRANSFORM programs PREPEND ${PROJECT_SOURCE_DIR}/ OUTPUT_VARIABLE program_files)
  set(generated ${CMAKE_BINARY_DIR}/generated/embedded_kernels.cpp)
  add_custom_command(
    OUTPUT ${generated}
    COMMAND ${CMAKE_COMMAND} -E make_directory ${CMAKE_BINARY_DIR}/generated
    COMMAND embed_kernels ${PROJECT_SOURCE_DIR} ${generated} ${programs}
    DEPENDS embed_kernels ${program_files} ${included}
    COMMENT "Embedding OpenCL kernels"
    VERBATIM)
  target_sources(${target} PRIVATE ${generated})
endfunction()
