# Exports the targets: as an ament package if ament_cmake is available, as a plain CMake package otherwise.
find_package(ament_cmake QUIET)
if(ament_cmake_FOUND)
  find_package(ament_cmake_python REQUIRED)
  ament_python_install_package(ur_simulator PACKAGE_DIR ${PROJECT_SOURCE_DIR}/python/ur_simulator)
  ament_export_targets(ur_simulatorTargets HAS_LIBRARY_TARGET NAMESPACE ur_simulator::)
  ament_export_dependencies(nlohmann_json)
  ament_package()
  return()
endif()

include(CMakePackageConfigHelpers)
install(EXPORT ur_simulatorTargets NAMESPACE ur_simulator:: DESTINATION share/${PROJECT_NAME}/cmake)
configure_package_config_file(cmake/ur_simulatorConfig.cmake.in ${CMAKE_CURRENT_BINARY_DIR}/ur_simulatorConfig.cmake
                              INSTALL_DESTINATION share/${PROJECT_NAME}/cmake)
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/ur_simulatorConfigVersion.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/ur_simulatorConfig.cmake
              ${CMAKE_CURRENT_BINARY_DIR}/ur_simulatorConfigVersion.cmake
        DESTINATION share/${PROJECT_NAME}/cmake)
