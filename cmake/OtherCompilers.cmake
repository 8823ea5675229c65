# What a tree of another compiler or of other options (presets golden-*) need not compile.
#
# Compilers may differ in what computes: kernels, scenes, geometry, the pipeline. What reads files, runs launches and
# keeps the books of a world takes half of the time and computes next to nothing, so it comes from TANDEM_OBJECTS_FROM.
# So do kernels of which no hash is compared: those in double, and those that only reverse the order of others.
foreach(objects tandem_objects tandem_io_objects)
  get_target_property(sources ${objects} SOURCES)
  list(FILTER sources EXCLUDE REGEX
    "/host/(io|world|runtime)/|/(embedded_kernels|worker_threads|backward|reference|reference_storage)[.]cpp$")
  set_target_properties(${objects} PROPERTIES SOURCES "${sources}")
endforeach()
set_target_properties(tandem_io_objects PROPERTIES DISABLE_PRECOMPILE_HEADERS ON) # it has one group of sources
# What is missing in golden_hashes, and no more.
foreach(library tandem tandem_io)
  add_library(borrowed_${library} STATIC IMPORTED)
  set_target_properties(borrowed_${library} PROPERTIES IMPORTED_LOCATION ${TANDEM_OBJECTS_FROM}/lib${library}.a)
endforeach()
target_link_libraries(borrowed_tandem INTERFACE TBB::tbb OpenCL::OpenCL fmt::fmt)
target_link_libraries(borrowed_tandem_io INTERFACE borrowed_tandem TinyGLTF::TinyGLTF tinyobjloader::tinyobjloader
  tinyxml2::tinyxml2)
