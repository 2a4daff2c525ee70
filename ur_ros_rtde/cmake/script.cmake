# ur_ros_rtde_script: reads, marks and composes URScript, without ROS and without a robot.
find_package(fmt REQUIRED)
find_package(tl-expected REQUIRED)

file(GLOB script_sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_LIST_DIR}/../src/script/*.cpp)
add_library(ur_ros_rtde_script STATIC ${script_sources})
ur_ros_rtde_settings(ur_ros_rtde_script)
target_include_directories(ur_ros_rtde_script
  PUBLIC
    $<BUILD_INTERFACE:${CMAKE_CURRENT_LIST_DIR}/../include>
    $<INSTALL_INTERFACE:include/${PROJECT_NAME}>)
target_link_libraries(ur_ros_rtde_script PUBLIC tl::expected PRIVATE fmt::fmt)
