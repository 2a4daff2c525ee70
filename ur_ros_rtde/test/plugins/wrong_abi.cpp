// What a library that was built with other headers exports.
extern "C" const char * ur_ros_rtde_plugin_abi()
{
  return "another";
}
