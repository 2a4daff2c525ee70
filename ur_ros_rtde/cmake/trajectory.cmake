# ur_ros_rtde_trajectory: kinematics, path, time-optimal timing and splines, without ROS and without a robot.
find_package(Eigen3 REQUIRED)
find_package(fmt REQUIRED)
find_package(tl-expected REQUIRED)

include(${CMAKE_CURRENT_LIST_DIR}/settings.cmake)

file(GLOB trajectory_sources CONFIGURE_DEPENDS
  ${CMAKE_CURRENT_LIST_DIR}/../src/trajectory/*.cpp ${CMAKE_CURRENT_LIST_DIR}/../src/kinematics/*.cpp)
add_library(ur_ros_rtde_trajectory SHARED ${trajectory_sources})
ur_ros_rtde_settings(ur_ros_rtde_trajectory)
target_compile_options(ur_ros_rtde_trajectory PRIVATE $<$<CONFIG:Release,RelWithDebInfo>:-O3>)
target_include_directories(ur_ros_rtde_trajectory
  PUBLIC
    $<BUILD_INTERFACE:${CMAKE_CURRENT_LIST_DIR}/../include>
    $<INSTALL_INTERFACE:include/${PROJECT_NAME}>)
target_link_libraries(ur_ros_rtde_trajectory
  PUBLIC Eigen3::Eigen tl::expected
  PRIVATE fmt::fmt)
