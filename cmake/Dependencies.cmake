# The libraries that Tandem builds on, all Debian packages; docs/dependencies.md lists them with their reasons.
find_package(TBB REQUIRED)
find_package(OpenCL REQUIRED)
find_package(Eigen3 REQUIRED NO_MODULE)
find_package(nlohmann_json REQUIRED)
find_package(fmt REQUIRED)
find_package(TinyGLTF REQUIRED)
find_package(tinyobjloader REQUIRED)
find_package(tinyxml2 REQUIRED)

if(TANDEM_BUILD_COMMAND)
  find_package(CLI11 REQUIRED)
  find_package(PNG REQUIRED)
endif()

add_library(tandem_dependencies INTERFACE)
target_link_libraries(tandem_dependencies INTERFACE Eigen3::Eigen nlohmann_json::nlohmann_json fmt::fmt
  TinyGLTF::TinyGLTF)
