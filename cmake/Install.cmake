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
# What tandem_add_module() compiles kernels of other projects with: the shared source, MiniCL's widths, and the program
# that writes OpenCL entries.
set(TANDEM_MODULE_ROOT ${CMAKE_INSTALL_DATADIR}/tandem)
set(TANDEM_MODULE_TEMPLATES ${package_dir}/module)
install(DIRECTORY shared cl DESTINATION ${TANDEM_MODULE_ROOT} FILES_MATCHING PATTERN "*.h" PATTERN "*.def")
install(DIRECTORY minicl DESTINATION ${TANDEM_MODULE_ROOT} FILES_MATCHING PATTERN "*.h" PATTERN "*.inc")
install(DIRECTORY host/runtime/interface DESTINATION ${TANDEM_MODULE_ROOT}/host/runtime FILES_MATCHING PATTERN "*.h"
  PATTERN "*.inc")
install(DIRECTORY cmake/module/ DESTINATION ${TANDEM_MODULE_TEMPLATES})
install(FILES cmake/TandemModules.cmake DESTINATION ${package_dir})
install(TARGETS embed_kernels EXPORT tandem_targets RUNTIME DESTINATION ${CMAKE_INSTALL_LIBEXECDIR}/tandem)
if(TARGET tandem_command)
  install(TARGETS tandem_command RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endif()

configure_package_config_file(cmake/TandemConfig.cmake.in ${CMAKE_BINARY_DIR}/package/TandemConfig.cmake
  INSTALL_DESTINATION ${package_dir} PATH_VARS TANDEM_INCLUDE_DIR TANDEM_MODULE_ROOT TANDEM_MODULE_TEMPLATES)
write_basic_package_version_file(${CMAKE_BINARY_DIR}/package/TandemConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/package/TandemConfig.cmake ${CMAKE_BINARY_DIR}/package/TandemConfigVersion.cmake
  DESTINATION ${package_dir})
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
