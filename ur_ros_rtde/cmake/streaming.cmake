# ur_ros_rtde_streaming: how a trajectory is driven, for the plugins of the group `trajectory`; and these plugins.
find_package(nlohmann_json REQUIRED)
find_package(trajectory_msgs REQUIRED)

file(GLOB streaming_sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_LIST_DIR}/../src/streaming/*.cpp)
add_library(ur_ros_rtde_streaming STATIC ${streaming_sources})
ur_ros_rtde_settings(ur_ros_rtde_streaming)
target_link_libraries(ur_ros_rtde_streaming PUBLIC
  ur_ros_rtde_plugin_api ur_ros_rtde_trajectory ${trajectory_msgs_TARGETS})

ur_ros_rtde_commands(src/commands/trajectory command.hpp)
target_link_libraries(ur_ros_rtde_trajectory_commands PRIVATE ur_ros_rtde_streaming)

# What ./ur plan runs.
add_executable(plan_trajectory src/programs/plan_trajectory.cpp)
ur_ros_rtde_settings(plan_trajectory)
target_link_libraries(plan_trajectory PRIVATE
  ur_ros_rtde_trajectory ur_ros_rtde_robot fmt::fmt nlohmann_json::nlohmann_json)
install(TARGETS plan_trajectory RUNTIME DESTINATION lib/${PROJECT_NAME})
