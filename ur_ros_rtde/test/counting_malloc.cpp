#include "counting_malloc.hpp"

#include <dlfcn.h>

#include <cstdlib>

namespace {
thread_local std::size_t allocations = 0;
}  // namespace

// rcl's function, in whose place the libraries of this program call this one.
extern "C" int rcl_publish(const void * publisher, const void * message, void * allocation)
{
  static const auto publish = reinterpret_cast<decltype(&rcl_publish)>(dlsym(RTLD_NEXT, "rcl_publish"));
  const std::size_t before = allocations;
  const int result = publish(publisher, message, allocation);
  allocations = before;
  return result;
}

#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)

// The names under which glibc provides its allocator to replacements of malloc.
extern "C" {
void * __libc_malloc(std::size_t size);                           // NOLINT(bugprone-reserved-identifier)
void * __libc_calloc(std::size_t count, std::size_t size);        // NOLINT(bugprone-reserved-identifier)
void * __libc_realloc(void * memory, std::size_t size);           // NOLINT(bugprone-reserved-identifier)
void * __libc_memalign(std::size_t alignment, std::size_t size);  // NOLINT(bugprone-reserved-identifier)

void * malloc(std::size_t size) noexcept
{
  ++allocations;
  return __libc_malloc(size);
}

void * calloc(std::size_t count, std::size_t size) noexcept
{
  ++allocations;
  return __libc_calloc(count, size);
}

void * realloc(void * memory, std::size_t size) noexcept
{
  ++allocations;
  return __libc_realloc(memory, size);
}

void * aligned_alloc(std::size_t alignment, std::size_t size) noexcept
{
  ++allocations;
  return __libc_memalign(alignment, size);
}
}

const bool ur_ros_rtde::test::allocations_are_counted = true;
#else
const bool ur_ros_rtde::test::allocations_are_counted = false;
#endif

std::size_t ur_ros_rtde::test::allocations_of_this_thread()
{
  return allocations;
}
