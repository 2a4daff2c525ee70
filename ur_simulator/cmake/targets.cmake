# Installed targets: the library that tests embed, and the program.
include(GNUInstallDirs)

# One shared library contains all modules: users depend only on the public header and nlohmann_json.
add_library(ur_simulator SHARED $<TARGET_OBJECTS:sim_library>)
add_library(ur_simulator::ur_simulator ALIAS ur_simulator)
target_include_directories(ur_simulator PUBLIC $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include>
                                               $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
target_link_libraries(ur_simulator PUBLIC nlohmann_json::nlohmann_json PRIVATE sim_controller)
target_compile_features(ur_simulator PUBLIC cxx_std_20)

add_executable(ur_simulator_app src/app/main.cpp src/app/options.cpp src/app/robots.cpp src/app/status_display.cpp
               src/app/status_text.cpp)
target_compile_definitions(ur_simulator_app PRIVATE UR_SIMULATOR_VERSION="${PROJECT_VERSION}")
target_link_libraries(ur_simulator_app PRIVATE sim_controller CLI11::CLI11)
# It parses the command line; optimizing CLI11 would double the compile time.
target_compile_options(ur_simulator_app PRIVATE -Wall -Wextra -Wpedantic -Wshadow -Wconversion
  $<$<CONFIG:Release,RelWithDebInfo>:-O0>)
set_target_properties(ur_simulator_app PROPERTIES OUTPUT_NAME ur_simulator RUNTIME_OUTPUT_DIRECTORY bin)

install(TARGETS ur_simulator EXPORT ur_simulatorTargets LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(DIRECTORY include/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(TARGETS ur_simulator_app RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
# `ros2 run` looks for programs here.
install(TARGETS ur_simulator_app RUNTIME DESTINATION lib/${PROJECT_NAME})
