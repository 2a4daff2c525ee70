#include "failing_publish.hpp"

#include <dlfcn.h>
#include <rcl/error_handling.h>
#include <rcl/publisher.h>

namespace {
thread_local bool fails = false;
}

FailingPublish::FailingPublish()
{
  fails = true;
}
FailingPublish::~FailingPublish()
{
  fails = false;
}

extern "C" rcl_ret_t rcl_publish(const rcl_publisher_t * publisher, const void * message,
                                 rmw_publisher_allocation_t * allocation)
{
  if (fails) {
    RCL_SET_ERROR_MSG("the network is down");
    return RCL_RET_ERROR;
  }
  static const auto publish = reinterpret_cast<decltype(&rcl_publish)>(dlsym(RTLD_NEXT, "rcl_publish"));
  return publish(publisher, message, allocation);
}
