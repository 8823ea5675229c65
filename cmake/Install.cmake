# The find_package(Tandem) package: libraries, headers and command. Each library has its own list of targets, so that a
# program that asks for physics alone needs no package of the others.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(TANDEM_INCLUDE_DIR ${CMAKE_INSTALL_INCLUDEDIR})
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/Tandem)
install(DIRECTORY host/include/tandem DESTINATION ${TANDEM_INCLUDE_DIR} FILES_MATCHING PATTERN "*.h")
foreach(library IN LISTS libraries)
  set(forms ${library})
  if(TANDEM_SHARED_LIBRARIES)
    list(APPEND forms ${library}_shared)
  endif()
  install(TARGETS ${forms} EXPORT ${library}_targets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
    LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
  install(EXPORT ${library}_targets NAMESPACE Tandem:: DESTINATION ${package_dir})
endforeach()
if(TARGET tandem_command)
  install(TARGETS tandem_command RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endif()

configure_package_config_file(cmake/TandemConfig.cmake.in ${CMAKE_BINARY_DIR}/package/TandemConfig.cmake
  INSTALL_DESTINATION ${package_dir} PATH_VARS TANDEM_INCLUDE_DIR)
write_basic_package_version_file(${CMAKE_BINARY_DIR}/package/TandemConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/package/TandemConfig.cmake ${CMAKE_BINARY_DIR}/package/TandemConfigVersion.cmake
  DESTINATION ${package_dir})
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
