#pragma once

#include <rcl/arguments.h>

#include <memory>
#include <mutex>

namespace rcl_cxx::detail {
/// rcl's and rcutils' logging is one per process and not thread-safe: whoever touches it (also by creating a
/// node, which adds a /rosout publisher) holds this.
std::recursive_mutex & logging_mutex();

/// rcl logging, configured from `arguments` by the first caller, shut down when the last copy is released.
std::shared_ptr<void> configure_logging(const rcl_arguments_t & arguments);

}  // namespace rcl_cxx::detail
