#pragma once

#include <cstddef>

/// The number of calls of operator new in this thread. The operator of the program is replaced.
std::size_t allocations_of_this_thread();
