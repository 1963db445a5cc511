# SPDX-FileCopyrightText: 2026 The opponens authors
# SPDX-License-Identifier: BSD-3-Clause
include(CMakePackageConfigHelpers)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/opponens)
install(EXPORT opponens NAMESPACE opponens:: DESTINATION ${package_dir} FILE opponens-targets.cmake)
configure_package_config_file(cmake/opponens-config.cmake.in ${PROJECT_BINARY_DIR}/opponens-config.cmake
  INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/opponens-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/opponens-config.cmake ${PROJECT_BINARY_DIR}/opponens-config-version.cmake
  DESTINATION ${package_dir})
install(DIRECTORY models DESTINATION ${CMAKE_INSTALL_DATADIR}/opponens)
