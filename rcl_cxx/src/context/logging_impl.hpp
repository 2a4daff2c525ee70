#pragma once

#include <rcl/arguments.h>

#include <memory>
#include <mutex>

namespace rcl_cxx::detail {
/// Guards the logging of rcl and rcutils, which is global and not thread-safe. Creating a node adds a /rosout
/// publisher and needs it, too.
std::recursive_mutex & logging_mutex();

/// The first caller configures rcl logging from `arguments`. It is shut down with the last copy of the
/// result.
std::shared_ptr<void> configure_logging(const rcl_arguments_t & arguments);

}  // namespace rcl_cxx::detail
