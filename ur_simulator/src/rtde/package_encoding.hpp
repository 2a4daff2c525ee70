#pragma once

#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <vector>

#include "common/types.hpp"

namespace ur_simulator::rtde {

// Encoding of RTDE packages (UR, "Real-Time Data Exchange (RTDE) Guide", "Protocol" and "RTDE Data Types").
// All values are big-endian.

enum class FieldType { boolean, uint8, uint32, uint64, int32, double_, vector3d, vector6d, vector6int32 };

/// The name in a recipe reply: "BOOL", "VECTOR6D", …
std::string_view type_name(FieldType type);
/// Encoded size, bytes.
std::size_t encoded_size(FieldType type);
/// Splits "a,b". A trailing comma is ignored.
std::vector<std::string_view> split_names(std::string_view names);

/// Package types; the value is the type byte.
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

/// Encodes values into a buffer. The caller provides a buffer of sufficient size.
class PackageWriter {
 public:
  explicit PackageWriter(char * buffer) : next_(buffer) {}

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
    std::memcpy(next_, &value, sizeof(T));
    next_ += sizeof(T);
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
    std::memcpy(next_, bytes.data(), bytes.size());
    next_ += bytes.size();
  }

 private:
  char * next_;
};

/// Decodes values. Reading past the end returns zeros and sets ok() to false.
class PackageReader {
 public:
  explicit PackageReader(std::string_view bytes) : unread_(bytes) {}

  bool ok() const { return ok_; }
  /// Number of unread bytes.
  std::size_t remaining() const { return unread_.size(); }
  std::uint8_t read_u8() { return read<std::uint8_t>(); }
  std::uint16_t read_u16() { return __builtin_bswap16(read<std::uint16_t>()); }
  std::uint32_t read_u32() { return __builtin_bswap32(read<std::uint32_t>()); }
  std::int32_t read_i32() { return static_cast<std::int32_t>(read_u32()); }
  double read_f64() { return std::bit_cast<double>(__builtin_bswap64(read<std::uint64_t>())); }
  Vector6 read_vector6()
  {
    Vector6 values;
    for (Eigen::Index i = 0; i < 6; ++i) {
      values[i] = read_f64();
    }
    return values;
  }
  std::string_view read_bytes(std::size_t count)
  {
    if (count > unread_.size()) {
      ok_ = false;
      count = unread_.size();
    }
    const std::string_view bytes = unread_.substr(0, count);
    unread_.remove_prefix(count);
    return bytes;
  }
  std::string_view read_remaining() { return read_bytes(unread_.size()); }

 private:
  template <typename T>
  T read()
  {
    T value{};
    if (unread_.size() < sizeof(T)) {
      ok_ = false;
      unread_ = {};
      return value;
    }
    std::memcpy(&value, unread_.data(), sizeof(T));
    unread_.remove_prefix(sizeof(T));
    return value;
  }

  std::string_view unread_;
  bool ok_ = true;
};

}  // namespace ur_simulator::rtde
