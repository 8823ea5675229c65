# embed_kernels(target [feature...]): compiles cl/*.cl, with every include and entry written out, into the target; the
# kernels of these features are left out.
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
  set(source ${PROJECT_SOURCE_DIR})
  file(GLOB programs CONFIGURE_DEPENDS RELATIVE ${source} ${source}/cl/*.cl)
  file(GLOB_RECURSE included CONFIGURE_DEPENDS ${source}/shared/*.h ${source}/shared/*.def ${source}/cl/*.h)
  list(TRANSFORM programs PREPEND ${source}/ OUTPUT_VARIABLE program_files)
  set(folder ${CMAKE_CURRENT_BINARY_DIR}/generated)
  set(generated ${folder}/embedded_kernels.cpp)
  set(without)
  if(ARGN)
    list(JOIN ARGN "," names)
    set(without --without ${names})
  endif()
  add_custom_command(
    OUTPUT ${generated}
    COMMAND ${CMAKE_COMMAND} -E make_directory ${folder}
    COMMAND embed_kernels ${source} ${folder} ${without} ${programs}
    DEPENDS embed_kernels ${program_files} ${included}
    COMMENT "Embedding OpenCL kernels"
    VERBATIM)
  target_sources(${target} PRIVATE ${generated})
endfunction()
