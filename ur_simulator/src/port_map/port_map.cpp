#include "port_map/port_map.hpp"

#include <algorithm>
#include <iterator>
#include <span>

#include "port_map/port_range.hpp"

namespace ur_simulator {
namespace {

using port_map::PortRange;
using port_map::PortSource;

/// The range of the version that contains the address, or null.
template <typename Value>
const PortRange<Value> * find_range(std::span<const PortRange<Value>> ranges, unsigned address,
                                    const PolyscopeVersion & version)
{
  const auto after = std::ranges::upper_bound(ranges, address, {}, &PortRange<Value>::first);
  if (after == ranges.begin()) {
    return nullptr;
  }
  const PortRange<Value> & range = *std::prev(after);
  return address - range.first < range.count && range.since.is_met_by(version) ? &range : nullptr;
}

template <typename Value>
Value read_port(std::span<const PortRange<Value>> ranges, unsigned address, const PortSource & source)
{
  const PortRange<Value> * range = find_range(ranges, address, source.version);
  return range != nullptr && range->read != nullptr ? range->read(source, address - range->first) : Value{};
}

template <typename Value>
PortWrite check_port(const PortRange<Value> * range, Value value)
{
  if (range == nullptr || range->write == nullptr) {
    return PortWrite::illegal_address;
  }
  return range->accepts == nullptr || range->accepts(value) ? PortWrite::possible : PortWrite::illegal_value;
}

template <typename Value>
void write_port(const PortRange<Value> * range, ControllerState & state, unsigned address, Value value)
{
  if (check_port(range, value) == PortWrite::possible) {
    range->write(state, address - range->first, value);
  }
}

}  // namespace

std::optional<std::uint16_t> PortMap::read_register(unsigned address) const
{
  return address < register_count
             ? std::optional(read_port(port_map::register_ranges(), address, {state_, version_}))
             : std::nullopt;
}

std::optional<bool> PortMap::read_bit(unsigned address) const
{
  return address < bit_count ? std::optional(read_port(port_map::bit_ranges(), address, {state_, version_}))
                             : std::nullopt;
}

PortWrite PortMap::check_register(unsigned address, std::uint16_t value) const
{
  return check_port(find_range(port_map::register_ranges(), address, version_), value);
}

PortWrite PortMap::check_bit(unsigned address, bool value) const
{
  return check_port(find_range(port_map::bit_ranges(), address, version_), value);
}

void PortMap::write_register(unsigned address, std::uint16_t value)
{
  write_port(find_range(port_map::register_ranges(), address, version_), state_, address, value);
}

void PortMap::write_bit(unsigned address, bool value)
{
  write_port(find_range(port_map::bit_ranges(), address, version_), state_, address, value);
}

}  // namespace ur_simulator
