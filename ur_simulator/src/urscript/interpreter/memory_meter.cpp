#include "urscript/interpreter/memory_meter.hpp"

namespace ur_simulator::urscript {

namespace {

constexpr std::size_t storage_overhead = 64;  // bytes: reference counts, the container, the allocator

}  // namespace

void MemoryMeter::add(std::span<const Value> values)
{
  bytes_ += values.size_bytes();
  for (const Value & value : values) {
    const bool counted = value.shares_storage() && !counted_.insert(value.storage()).second;
    if (value.storage() != nullptr && !counted) {
      bytes_ += storage_overhead;
      add_storage(value);
    }
  }
}

void MemoryMeter::add_storage(const Value & value)
{
  switch (value.type()) {
    case Type::string:
      bytes_ += value.string().capacity();
      return;
    case Type::matrix:
      bytes_ += value.matrix().elements.capacity() * sizeof(double);
      return;
    case Type::list:
      add(value.list());
      return;
    case Type::structure:
      for (const auto & [name, member] : value.structure().members) {
        bytes_ += name.capacity();
        add(std::span(&member, 1));
      }
      return;
    default:
      bytes_ += sizeof(Vector6);
      return;
  }
}

}  // namespace ur_simulator::urscript
