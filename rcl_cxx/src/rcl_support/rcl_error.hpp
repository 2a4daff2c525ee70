#pragma once

#include <fmt/format.h>
#include <rcl/error_handling.h>
#include <rcl/types.h>

#include <string>
#include <string_view>

#include "rcl_cxx/error.hpp"

namespace rcl_cxx::detail {
/// The text of rcl's error state, which is reset.
inline std::string take_rcl_error()
{
  std::string text = rcl_error_is_set() ? rcl_get_error_string().str : "no details";
  rcl_reset_error();
  return text;
}

/// @throws Error if `code` is not RCL_RET_OK
inline void check_rcl(rcl_ret_t code, std::string_view entity, std::string_view action)
{
  if (code != RCL_RET_OK) {
    throw Error(fmt::format("{}: {} (rcl error {}: {})", entity, action, code, take_rcl_error()), code);
  }
}

/// For destructors: an rcl object that cannot be finalized is leaked.
inline void ignore_rcl(rcl_ret_t code) noexcept
{
  if (code != RCL_RET_OK) {
    rcl_reset_error();
  }
}

/// Returned by guard_serialization().
constexpr rcl_ret_t kCannotSerialize = -1;

/// Calls an rcl function that serializes a message. The middleware throws if a string contains a null
/// character; its exceptions are not derived from std::exception for this library.
template <typename Send>
rcl_ret_t guard_serialization(const Send & send) noexcept
{
  try {
    return send();
  } catch (...) {
    RCL_SET_ERROR_MSG("the middleware cannot serialize the message: does a string contain a null character?");
    return kCannotSerialize;
  }
}

}  // namespace rcl_cxx::detail
