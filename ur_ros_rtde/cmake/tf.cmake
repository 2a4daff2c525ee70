# The transform base -> tool0_controller needs tf2_msgs. If tf2_msgs is not installed, test/tf2_msgs defines the same
# message, and a second robot_state_receiver that broadcasts the transform is built for the tests.
find_package(tf2_msgs QUIET)

if(tf2_msgs_FOUND)
  target_link_libraries(ur_ros_rtde_nodes PUBLIC ${tf2_msgs_TARGETS})
elseif(BUILD_TESTING)
  add_subdirectory(test/tf2_msgs)
  rosidl_get_typesupport_target(tf2_msgs_interfaces tf2_msgs rosidl_typesupport_cpp)
  # This program compiles tool_transform.cpp itself. To replace the one in the static library, that must be an object
  # file of its own there.
  set_source_files_properties(src/state/tool_transform.cpp PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  add_executable(robot_state_receiver_with_tf
    src/programs/robot_state_receiver.cpp src/state/tool_transform.cpp)
  ur_ros_rtde_settings(robot_state_receiver_with_tf)
  target_link_libraries(robot_state_receiver_with_tf PRIVATE ur_ros_rtde_nodes ${tf2_msgs_interfaces})
  set_target_properties(robot_state_receiver_with_tf PROPERTIES
    OUTPUT_NAME robot_state_receiver
    RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/test/tf2_msgs)
endif()
