#include "ur_ros_rtde/plugin.hpp"

namespace test {

int defined_nowhere();

class UndefinedSymbol : public ur_ros_rtde::CommandPlugin {
 public:
  void start_action_server(ur_ros_rtde::CommandHost &, const std::string &) override {}
  void stop_action_server() override {}
  int value = value_of_it();

 private:
  static int value_of_it() { return *function; }
  static int * const function;
};

extern int data_defined_nowhere;
int * const UndefinedSymbol::function = &data_defined_nowhere;

UR_ROS_RTDE_EXPORT(UndefinedSymbol, "undefined_symbol")

}  // namespace test
