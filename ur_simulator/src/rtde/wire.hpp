#pragma once

#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>

#include "common/types.hpp"

namespace ur_simulator::rtde {

/// Types of RTDE fields, as UR's "Real-Time Data Exchange (RTDE) Guide" names them.
enum class FieldType { boolean, uint8, uint32, uint64, int32, double_, vector3d, vector6d, vector6int32 };

/// "BOOL", "VECTOR6D", …
std::string_view name(FieldType type);
/// Bytes on the wire.
std::size_t size(FieldType type);

/// Package types of the protocol (the ASCII letter is the type byte).
enum class PackageType : std::uint8_t {
  request_protocol_version = 'V',
  get_urcontrol_version = 'v',
  text_message = 'M',
  data_package = 'U',
  setup_outputs = 'O',
  setup_inputs = 'I',
  start = 'S',
  pause = 'P',
};

constexpr std::size_t header_size = 3;  ///< uint16 package size including the header, uint8 type

/// Writes big-endian values into memory the caller has sized.
class Writer {
 public:
  explicit Writer(char * at) : at_(at) {}

  template <std::unsigned_integral T>
  void put(T value)
  {
    if constexpr (sizeof(T) == 2) {
      value = __builtin_bswap16(value);
    } else if constexpr (sizeof(T) == 4) {
      value = __builtin_bswap32(value);
    } else if constexpr (sizeof(T) == 8) {
      value = __builtin_bswap64(value);
    }
    std::memcpy(at_, &value, sizeof(T));
    at_ += sizeof(T);
  }
  void put(std::int32_t value) { put(static_cast<std::uint32_t>(value)); }
  void put(double value) { put(std::bit_cast<std::uint64_t>(value)); }
  void put(bool value) { put(static_cast<std::uint8_t>(value ? 1 : 0)); }
  template <typename Derived>
  void put(const Eigen::MatrixBase<Derived> & values)
  {
    for (Eigen::Index i = 0; i < values.size(); ++i) {
      put(static_cast<double>(values[i]));
    }
  }
  void put(std::string_view bytes)
  {
    std::memcpy(at_, bytes.data(), bytes.size());
    at_ += bytes.size();
  }

 private:
  char * at_;
};

/// Reads big-endian values; reading past the end yields zeros and makes ok() false.
class Reader {
 public:
  explicit Reader(std::string_view bytes) : bytes_(bytes) {}

  bool ok() const { return ok_; }
  std::size_t left() const { return bytes_.size(); }
  std::uint8_t u8() { return take<std::uint8_t>(); }
  std::uint16_t u16() { return __builtin_bswap16(take<std::uint16_t>()); }
  std::uint32_t u32() { return __builtin_bswap32(take<std::uint32_t>()); }
  std::int32_t i32() { return static_cast<std::int32_t>(u32()); }
  double f64() { return std::bit_cast<double>(__builtin_bswap64(take<std::uint64_t>())); }
  Vector6 vector6()
  {
    Vector6 values;
    for (Eigen::Index i = 0; i < 6; ++i) {
      values[i] = f64();
    }
    return values;
  }
  std::string_view bytes(std::size_t count)
  {
    if (count > bytes_.size()) {
      ok_ = false;
      count = bytes_.size();
    }
    const std::string_view taken = bytes_.substr(0, count);
    bytes_.remove_prefix(count);
    return taken;
  }
  std::string_view rest() { return bytes(bytes_.size()); }

 private:
  template <typename T>
  T take()
  {
    T value{};
    if (bytes_.size() < sizeof(T)) {
      ok_ = false;
      bytes_ = {};
      return value;
    }
    std::memcpy(&value, bytes_.data(), sizeof(T));
    bytes_.remove_prefix(sizeof(T));
    return value;
  }

  std::string_view bytes_;
  bool ok_ = true;
};

}  // namespace ur_simulator::rtde
