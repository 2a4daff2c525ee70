#include "controller/rtde_value.hpp"

#include <array>
#include <limits>

#include "rtde/fields.hpp"

namespace ur_simulator {

namespace {

using rtde::FieldType;
using rtde::PackageReader;
using urscript::Value;

Value number(std::uint64_t value)
{
  constexpr auto largest = static_cast<std::uint64_t>(std::numeric_limits<std::int32_t>::max());
  return value <= largest ? Value(static_cast<std::int32_t>(value)) : Value(static_cast<double>(value));
}

std::uint64_t read_u64(PackageReader & from)
{
  const std::uint64_t high = from.read_u32();
  return high << 32U | from.read_u32();
}

Value decode(FieldType type, PackageReader from)
{
  switch (type) {
    case FieldType::boolean:
      return from.read_u8() != 0;
    case FieldType::uint8:
      return number(from.read_u8());
    case FieldType::uint32:
      return number(from.read_u32());
    case FieldType::uint64:
      return number(read_u64(from));
    case FieldType::int32:
      return from.read_i32();
    case FieldType::double_:
      return from.read_f64();
    case FieldType::vector3d: {
      Vector3 values;
      for (double & value : values) {
        value = from.read_f64();
      }
      return Value::list(values);
    }
    case FieldType::vector6d:
      return Value::list(from.read_vector6());
    case FieldType::vector6int32: {
      urscript::List values;
      for (int i = 0; i < 6; ++i) {
        values.emplace_back(from.read_i32());
      }
      return values;
    }
  }
  return {};
}

}  // namespace

std::optional<Value> rtde_value(const ControllerState & state, const PolyscopeVersion & version,
                                std::string_view name)
{
  const rtde::OutputField * field = rtde::find_output_field(name, version);
  if (field == nullptr) {
    return std::nullopt;
  }
  std::array<char, 64> buffer{};  // the longest type is VECTOR6D
  rtde::PackageWriter writer(buffer.data());
  field->write(state, field->index, writer);
  return decode(field->type, PackageReader({buffer.data(), rtde::encoded_size(field->type)}));
}

}  // namespace ur_simulator
