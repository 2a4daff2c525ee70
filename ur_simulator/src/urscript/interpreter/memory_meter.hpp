#pragma once

#include <cstddef>
#include <span>
#include <unordered_set>

#include "urscript/value.hpp"

namespace ur_simulator::urscript {

/// Adds up the memory of values. Storage that several values share counts once.
class MemoryMeter {
 public:
  void add(std::span<const Value> values);
  std::size_t bytes() const { return bytes_; }

 private:
  void add_storage(const Value & value);

  std::size_t bytes_ = 0;
  std::unordered_set<const void *> counted_;
};

}  // namespace ur_simulator::urscript
