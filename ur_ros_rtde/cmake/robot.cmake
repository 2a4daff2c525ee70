# ur_ros_rtde_robot: the robot side, without ROS.
find_package(fmt REQUIRED)
find_package(tl-expected REQUIRED)
find_package(ur_rtde_vendor REQUIRED)
find_package(Threads REQUIRED)

include(${CMAKE_CURRENT_LIST_DIR}/script.cmake)

file(GLOB robot_sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/src/robot/*.cpp)
add_library(ur_ros_rtde_robot SHARED ${robot_sources})
# Classes with members of types that only their own file has, of which the compiler warns in a file that is included.
set_source_files_properties(src/robot/script_server.cpp src/robot/rtde_stream.cpp PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
ur_ros_rtde_settings(ur_ros_rtde_robot)
target_include_directories(ur_ros_rtde_robot
  PUBLIC
    $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include>
    $<INSTALL_INTERFACE:include/${PROJECT_NAME}>)
target_link_libraries(ur_ros_rtde_robot
  PUBLIC ur_rtde::rtde tl::expected Threads::Threads
  PRIVATE ur_ros_rtde_script fmt::fmt)
