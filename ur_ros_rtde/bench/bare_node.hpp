#pragma once

#include <rcl/error_handling.h>
#include <rcl/rcl.h>

#include <cstdio>
#include <cstdlib>

namespace bench {

[[noreturn]] inline void fail(const char * reason)
{
  std::fprintf(stderr, "%s\n", reason);
  std::exit(1);
}

/// Ends the program with rcl's message unless the call has succeeded.
inline void check(rcl_ret_t code)
{
  if (code != RCL_RET_OK) {
    fail(rcl_get_error_string().str);
  }
}

/// A node with nothing but rcl.
class BareNode {
 public:
  BareNode(const char * name, const char * name_space)
  {
    rcl_init_options_t options = rcl_get_zero_initialized_init_options();
    check(rcl_init_options_init(&options, rcl_get_default_allocator()));
    check(rcl_init(0, nullptr, &options, &context));
    const rcl_node_options_t node_options = rcl_node_get_default_options();
    check(rcl_node_init(&node, name, name_space, &context, &node_options));
    check(rcl_init_options_fini(&options));
  }
  ~BareNode()
  {
    check(rcl_node_fini(&node));
    check(rcl_shutdown(&context));
  }
  BareNode(const BareNode &) = delete;
  BareNode & operator=(const BareNode &) = delete;

  rcl_context_t context = rcl_get_zero_initialized_context();
  rcl_node_t node = rcl_get_zero_initialized_node();
};

}  // namespace bench
