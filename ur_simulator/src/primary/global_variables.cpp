#include "primary/global_variables.hpp"

#include <algorithm>
#include <utility>

#include "common/big_endian.hpp"

namespace ur_simulator::primary {
namespace {

using urscript::Type;
using urscript::Value;

constexpr std::uint8_t program_state_message = 25;
constexpr std::size_t max_length = 0xffff;  // of strings and lists: the length has two bytes

enum class ProgramStateType : std::uint8_t { setup = 0, update = 1 };

/// Type codes of values. They changed with the introduction of matrices.
struct TypeCodes {
  std::uint8_t pose, boolean, integer, floating, list;
  bool has_matrices;
};

constexpr std::uint8_t none_code = 0;
constexpr std::uint8_t string_code = 4;  // VAR_STRING
constexpr std::uint8_t matrix_code = 18;
constexpr TypeCodes codes_before_matrices{10, 12, 14, 15, 5, false};
constexpr TypeCodes present_codes{12, 13, 15, 16, 17, true};
constexpr MinVersion with_matrices{{5, 9, 0, 0}, {3, 14, 0, 0}};

void put_floating(std::string & to, const TypeCodes & codes, double value)
{
  put_u8(to, codes.floating);
  put_f32(to, static_cast<float>(value));
}

void put_value(std::string & to, const TypeCodes & codes, const Value & value);

void put_list(std::string & to, const TypeCodes & codes, const urscript::List & list)
{
  const std::size_t length = std::min(list.size(), max_length);
  put_u8(to, codes.list);
  put_u16(to, static_cast<std::uint16_t>(length));
  for (std::size_t i = 0; i < length; ++i) {
    put_value(to, codes, list[i]);
  }
}

void put_matrix(std::string & to, const TypeCodes & codes, const urscript::Matrix & matrix)
{
  if (!codes.has_matrices) {
    put_u8(to, none_code);
    return;
  }
  put_u8(to, matrix_code);
  put_u16(to, static_cast<std::uint16_t>(matrix.rows));
  put_u16(to, static_cast<std::uint16_t>(matrix.columns));
  for (const double element : matrix.elements) {
    put_floating(to, codes, element);
  }
}

void put_pose(std::string & to, const TypeCodes & codes, const Vector6 & pose)
{
  put_u8(to, codes.pose);
  for (const double coordinate : pose) {
    put_f32(to, static_cast<float>(coordinate));
  }
}

void put_string(std::string & to, const std::string & text)
{
  const std::string_view sent = std::string_view(text).substr(0, max_length);
  put_u8(to, string_code);
  put_u16(to, static_cast<std::uint16_t>(sent.size()));
  to += sent;
}

void put_value(std::string & to, const TypeCodes & codes, const Value & value)
{
  switch (value.type()) {
    case Type::boolean:
      put_u8(to, codes.boolean);
      put_u8(to, value.boolean() ? 1 : 0);
      break;
    case Type::integer:
      put_u8(to, codes.integer);
      put_u32(to, static_cast<std::uint32_t>(value.integer()));
      break;
    case Type::floating:
      put_floating(to, codes, value.floating());
      break;
    case Type::string:
      put_string(to, value.string());
      break;
    case Type::pose:
      put_pose(to, codes, value.pose());
      break;
    case Type::list:
      put_list(to, codes, value.list());
      break;
    case Type::matrix:
      put_matrix(to, codes, value.matrix());
      break;
    case Type::none:
    case Type::remote:
    case Type::structure:  // the protocol has no type for them
      put_u8(to, none_code);
      break;
  }
}

std::string make_message(ProgramStateType type, double timestamp, const std::string & body)
{
  constexpr std::size_t header_size = 16;
  std::string message;
  put_u32(message, static_cast<std::uint32_t>(header_size + body.size()));
  put_u8(message, program_state_message);
  put_u64(message, static_cast<std::uint64_t>(timestamp * 1e6));
  put_u8(message, static_cast<std::uint8_t>(type));
  put_u16(message, 0);  // index of the first variable of this message
  return message + body;
}

}  // namespace

std::string GlobalVariables::setup_message(const urscript::Machine & machine, double timestamp) const
{
  std::string names;
  for (const std::string & name : machine.global_names()) {
    if (names.size() + name.size() >= max_size) {
      break;
    }
    names += name + "\n";
  }
  return make_message(ProgramStateType::setup, timestamp, names);
}

std::string GlobalVariables::encode_values(const urscript::Machine & machine) const
{
  const TypeCodes & codes = with_matrices.is_met_by(version_) ? present_codes : codes_before_matrices;
  const Value none{};
  std::string values;
  std::size_t names_size = 0;
  for (const std::string & name : machine.global_names()) {
    names_size += name.size() + 1;
    if (names_size > max_size) {
      break;
    }
    std::string encoded;
    const Value * value = machine.global(name);
    put_value(encoded, codes, value == nullptr ? none : *value);
    if (values.size() + encoded.size() < max_size) {
      values += encoded;
    } else {
      put_u8(values, none_code);
    }
    values += '\n';
  }
  return values;
}

std::string GlobalVariables::all(const urscript::Machine & machine, double timestamp) const
{
  return setup_message(machine, timestamp) +
         make_message(ProgramStateType::update, timestamp, encode_values(machine));
}

std::string GlobalVariables::changes(const urscript::Machine & machine, double timestamp)
{
  std::string messages;
  std::string values = encode_values(machine);
  if (std::exchange(new_program_, false)) {
    messages = setup_message(machine, timestamp);
  } else if (values == sent_values_) {
    return messages;
  }
  messages += make_message(ProgramStateType::update, timestamp, values);
  sent_values_ = std::move(values);
  return messages;
}

}  // namespace ur_simulator::primary
