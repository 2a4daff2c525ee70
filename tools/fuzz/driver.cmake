# The parsers of the driver, compiled from their sources: the packages themselves need ROS.
include(GenerateExportHeader)
include(${REPOSITORY}/ur_rtde_vendor/cmake/source_archive.cmake)
include(${REPOSITORY}/ur_rtde_vendor/cmake/patched_source.cmake)

source_archive(https://gitlab.com/sdurobotics/ur_rtde/-/archive/v1.6.5/ur_rtde-v1.6.5.tar.gz archive)
patched_source("${archive}" "${REPOSITORY}/ur_rtde_vendor/sources.sha256" "${REPOSITORY}/ur_rtde_vendor/patches" ur_rtde)
add_library(fuzz_ur_rtde STATIC ${ur_rtde}/src/rtde.cpp ${ur_rtde}/src/robot_state.cpp ${ur_rtde}/src/dashboard_client.cpp
  ${ur_rtde}/src/dashboard_enums.cpp)
generate_export_header(fuzz_ur_rtde BASE_NAME rtde EXPORT_FILE_NAME ${CMAKE_CURRENT_BINARY_DIR}/ur_rtde/rtde_export.h)
target_include_directories(fuzz_ur_rtde SYSTEM PUBLIC ${ur_rtde}/include ${CMAKE_CURRENT_BINARY_DIR})
target_link_libraries(fuzz_ur_rtde PUBLIC Boost::thread Threads::Threads)

set(robot ${REPOSITORY}/ur_ros_rtde_robot)
file(GLOB robot_sources CONFIGURE_DEPENDS ${robot}/src/script/*.cpp)
add_library(fuzz_robot STATIC ${robot_sources}
  ${robot}/src/connection/dashboard_request.cpp ${robot}/src/connection/dashboard_session.cpp
  ${robot}/src/connection/primary_connection.cpp
  ${robot}/src/connection/rtde/rtde_probe.cpp
  ${robot}/src/connection/tcp_socket.cpp ${robot}/src/connection/text.cpp)
target_include_directories(fuzz_robot PUBLIC ${robot}/src ${robot}/include ${REPOSITORY}/ur_ros_rtde_trajectory/include)
target_link_libraries(fuzz_robot PUBLIC Eigen3::Eigen fmt::fmt Threads::Threads)

set(grippers ${REPOSITORY}/ur_ros_rtde_gripper_commands)
add_library(fuzz_robotiq STATIC ${grippers}/src/robotiq/robotiq_client.cpp)
target_include_directories(fuzz_robotiq PUBLIC ${grippers}/src)
target_link_libraries(fuzz_robotiq PUBLIC fuzz_robot)

find_library(ament_index_cpp ament_index_cpp PATHS "$ENV{ROS_WHEELS_PREFIX}/lib" REQUIRED)
add_library(fuzz_plugin_index STATIC ${REPOSITORY}/ur_ros_rtde/src/plugins/plugin_index.cpp)
target_include_directories(fuzz_plugin_index PUBLIC ${REPOSITORY}/ur_ros_rtde/src)
target_include_directories(fuzz_plugin_index SYSTEM PRIVATE $ENV{ROS_WHEELS_PREFIX}/include/ament_index_cpp)
target_link_libraries(fuzz_plugin_index PUBLIC fmt::fmt ${TINYXML2_LIBRARY} ${ament_index_cpp})

set(trajectory ${REPOSITORY}/ur_ros_rtde_trajectory)
add_library(fuzz_description STATIC ${REPOSITORY}/ur_ros_rtde/src/state/description_kinematics.cpp
  ${trajectory}/src/kinematics/arm.cpp ${trajectory}/src/trajectory/limits.cpp)
target_include_directories(fuzz_description PUBLIC ${REPOSITORY}/ur_ros_rtde/src ${trajectory}/include PRIVATE ${trajectory}/src)
target_link_libraries(fuzz_description PUBLIC Eigen3::Eigen fmt::fmt ${TINYXML2_LIBRARY})

add_fuzz_target(ur_ros_rtde_robot rtde_stream DEPENDS fuzz_robot fuzz_ur_rtde)
add_fuzz_target(ur_ros_rtde_robot primary_stream DEPENDS fuzz_robot)
add_fuzz_target(ur_ros_rtde_robot dashboard_replies DEPENDS fuzz_robot)
add_fuzz_target(ur_ros_rtde_robot dashboard_client DEPENDS fuzz_robot fuzz_ur_rtde)
add_fuzz_target(ur_ros_rtde_robot composed_script DEPENDS fuzz_robot)
add_fuzz_target(ur_ros_rtde plugin_description DEPENDS fuzz_plugin_index)
add_fuzz_target(ur_ros_rtde_gripper_commands robotiq_replies DEPENDS fuzz_robotiq)
add_fuzz_target(ur_ros_rtde robot_description DEPENDS fuzz_description)
