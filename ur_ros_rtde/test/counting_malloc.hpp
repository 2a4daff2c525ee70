#pragma once

#include <cstddef>

namespace ur_ros_rtde::test {

/// False in a build with a sanitizer, which replaces the allocator itself, and with another C library than
/// glibc.
extern const bool allocations_are_counted;

/// The number of allocations in this thread: malloc, calloc, realloc, aligned_alloc and everything based on
/// them, such as operator new, in this program and in all libraries. Those within rcl_publish() are not
/// counted: the shared memory transport of Fast DDS 3.2 allocates once for each message that has subscribers.
std::size_t allocations_of_this_thread();

}  // namespace ur_ros_rtde::test
