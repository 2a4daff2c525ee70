#pragma once

#include <cstddef>

/// How often operator new has been called in this thread, by anyone: the whole program's is replaced.
std::size_t allocations_of_this_thread();
